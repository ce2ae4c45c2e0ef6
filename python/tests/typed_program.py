"""A program of a user, with types."""

import paracosm as pc


def main() -> None:
    points = pc.sample(2, 20, method="sobol", seed=1)
    largest = pc.dispersion(points)
    assert largest.lower <= largest.upper
    if largest.box is not None:
        low, high = largest.box["x1"]
        assert low < high
    space = pc.Space({"speed": pc.Interval(0.5, 10, unit="m/s"), "lanes": [2, 4]})
    tests = pc.sample(space, 10)
    speeds: list[float] = tests["speed"].tolist()
    assert len(speeds) == len(tests)
    generator = pc.Generator(space, "auto", budget=20, seed=0)
    generator.tell(generator.ask(2), [0.5, None])
    assert pc.Formula("always (x < 3)").evaluate({"time": [0, 1], "x": [1, 2]}).truth is True


class Careful(pc.Driver):
    def step(self, observation: pc.Observation) -> pc.Control:
        return pc.Control(throttle=0.1 if observation.speed < 10 else 0.0)


if __name__ == "__main__":
    main()
