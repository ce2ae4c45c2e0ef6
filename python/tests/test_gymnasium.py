"""Environments of Gymnasium: the tests, traces and results are those of campaigns."""

import gc
import os
import subprocess
import sys
import textwrap
import time
import warnings

import numpy as np
import paracosm as pc
import pytest

gymnasium = pytest.importorskip("gymnasium")
import paracosm.gymnasium as pg  # noqa: E402
from gymnasium.utils.env_checker import check_env  # noqa: E402
from paracosm._core import Episode  # noqa: E402


def play(environment, policy, **reset):
    """Plays an episode, and returns the sum of the rewards, the number of steps, and the end."""
    observation, info = environment.reset(**reset)
    test, total, steps = info["test"], 0.0, 0
    while True:
        observation, reward, terminated, truncated, info = environment.step(policy(observation))
        total, steps = total + reward, steps + 1
        assert observation in environment.observation_space
        if terminated or truncated:
            return test, total, steps, (terminated, truncated), info


def coast(observation):
    return np.zeros(2, np.float32)


def test_every_scenario_has_its_environments():
    for name, _ in pc.scenarios():
        title = "".join(part.capitalize() for part in name.split("-"))
        assert {f"paracosm/{title}-v0", f"paracosm/{title}-Adversary-v0"} <= set(gymnasium.registry)
    named = [gymnasium.make(f"paracosm/{title}-v0") for title in ("CutIn", "PedestrianCrossing", "RoundaboutEntry", "TLoop")]
    assert [environment.unwrapped.reset(seed=1)[0].shape for environment in named] == [(98,)] * 4


@pytest.mark.parametrize("name", ["paracosm/CutIn-v0", "paracosm/PedestrianCrossing-v0", "paracosm/CutIn-Adversary-v0"])
def test_the_checker_of_gymnasium_accepts_the_environments(name):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        check_env(gymnasium.make(name).unwrapped)


@pytest.mark.parametrize("scenario", ["cut-in", "pedestrian-crossing"])
def test_an_episode_is_the_test_of_a_campaign_with_the_same_driver(scenario, tmp_path):
    class Same(pc.Driver):
        period = 0.1
        others = True

        def step(self, observation: pc.Observation) -> pc.Control:
            return pc.Control(0.3 if observation.speed < 8 else -0.1, 0.05 * observation.way.offset)

    study = pc.Study(scenario, budget=12)
    report = study.replace(driver=Same()).run(tmp_path / "out")
    played = 0
    for trial in (trial for trial in report if trial.verdict != "invalid"):
        driver = Same()
        episode = Episode(study, trial.test, driver, 0)
        observation = episode.asked()
        while observation is not None:
            episode.answer(driver.step(observation))
            observation = episode.asked()
        outcome = episode.outcome
        assert outcome is not None and outcome["trace_hash"] == trial.trace_hash
        assert (outcome["verdict"], outcome["robustness"]) == (trial.verdict, trial.robustness)
        played += 1
    assert played >= 6


@pytest.mark.parametrize("scenario", ["cut-in", "pedestrian-crossing", "follow-leader"])
def test_the_sum_of_the_rewards_is_the_worst_robustness(scenario):
    environment = pg.DrivingEnv(scenario)
    seen = set()
    for seed in range(6):
        _, total, _, (terminated, truncated), info = play(environment, coast if seed % 2 else lambda _: np.array([1.0, 0.0]), seed=seed)
        assert total == pytest.approx(np.clip(info["worst"], -1.0, 1.0), abs=1e-9)
        assert terminated != truncated and info["verdict"] in ("pass", "fail", "inconclusive")
        seen.add(info["verdict"])
    assert "fail" in seen or scenario == "follow-leader"


def test_a_formula_of_the_study_is_watched_at_every_step():
    environment = pg.DrivingEnv("cut-in", spec="always (car.speed > 1)")
    environment.reset(seed=3)
    rewards = []
    while True:
        _, reward, terminated, truncated, info = environment.step(np.array([-1.0, 0.0]))
        rewards.append(reward)
        if terminated or truncated:
            break
    assert info["verdict"] == "fail" and sum(rewards) == pytest.approx(np.clip(info["worst"], -1.0, 1.0), abs=1e-9)
    # The car brakes to a stop, and the upper bound falls with its speed before the end.
    assert sum(reward < 0 for reward in rewards[:-1]) >= 1


def test_the_same_seed_gives_the_same_episode_and_a_named_test_is_that_test():
    environment = pg.DrivingEnv("cut-in")
    first, again, other = (play(environment, coast, seed=seed) for seed in (5, 5, 6))
    assert first[0] == again[0] and first[4]["trace_hash"] == again[4]["trace_hash"] and first[0] != other[0]
    assert play(environment, coast, options={"test": first[0]})[4]["trace_hash"] == first[4]["trace_hash"]


def test_a_scenario_of_python_and_choices_of_a_study_make_an_environment():
    @pc.scenario(name="alone")
    def alone(s):
        speed = s.interval("v", 5.0, 10.0)
        road = s.place(pc.RoadSegment(300.0))
        car = s.place(pc.AutonomousVehicle(road.on_lane(1, 10.0)).speed(speed.value()))
        s.require("slow", pc.always(car.speed() < 12.0), scale=5.0)

    _, total, _, _, info = play(pg.DrivingEnv(alone, others=0, points=2), lambda _: np.array([1.0, 0.0]), seed=1)
    assert info["verdict"] == "fail" and total < 0
    opened = pg.DrivingEnv("cut-in", open={"friction": (0.3, 0.8)}, period=0.05)
    assert "friction" in opened.reset(seed=1)[1]["test"]


def test_images_are_observations_where_cameras_are_asked_for():
    cameras = {"front": pc.Camera(width=32, height=24)}
    try:
        pc.Study("cut-in", driver=lambda observation: pc.Control(0.0, 0.0), budget=1)
        environment = pg.DrivingEnv("cut-in", cameras=cameras)
        observation, begun = environment.reset(seed=1)
        for _ in range(5):
            observation, *_ = environment.step(np.zeros(2))
    except pc.Error as error:
        pytest.skip(f"nothing draws here: {error}")
    textured = pg.DrivingEnv("cut-in", cameras=cameras, look="textured")
    other, _ = textured.reset(options={"test": begun["test"]})
    for _ in range(5):
        other, *_ = textured.step(np.zeros(2))
    assert observation["front"].shape == (24, 32, 3) and observation["front"].std() > 5
    assert observation in environment.observation_space
    assert np.array_equal(observation["state"], other["state"]) and not np.array_equal(observation["front"], other["front"])


def test_several_episodes_run_at_once_and_begin_anew():
    together = gymnasium.make_vec("paracosm/CutIn-v0", num_envs=3)
    assert together.metadata["autoreset_mode"] is gymnasium.vector.AutoresetMode.NEXT_STEP
    observation, infos = together.reset(seed=4)
    assert observation.shape == (3, 98) and len(infos["test"]) == 3
    alone = [pg.DrivingEnv("cut-in") for _ in range(3)]
    for i, environment in enumerate(alone):
        environment.reset(options={"test": infos["test"][i]})
    over, rewards, begun = np.zeros(3, bool), np.zeros(3), 0
    for _ in range(400):
        action = np.tile(np.array([0.1, 0.0], np.float32), (3, 1))
        before = over
        observation, reward, terminated, truncated, infos = together.step(action)
        for i, environment in enumerate(alone):
            if not before[i] and begun == 0:
                expected = environment.step(action[i])
                assert (observation[i] == expected[0]).all() and reward[i] == expected[1]
                assert (terminated[i], truncated[i]) == expected[2:4]
        assert (reward[before] == 0.0).all() and not (terminated | truncated)[before].any()
        begun += before.sum()
        over = terminated | truncated
    assert begun > 3
    together.close()


def test_an_adversary_is_paid_for_progress_towards_a_failure():
    environment = gymnasium.make("paracosm/PedestrianCrossing-Adversary-v0", tests=30, driver="cruise")
    observation, _ = environment.reset(seed=1)
    total, least = 0.0, 1.0
    for _ in range(30):
        observation, reward, terminated, truncated, info = environment.step(environment.action_space.sample())
        if info["worst"] is not None:
            least = min(least, float(np.clip(info["worst"], -1.0, 1.0)))
        total += reward
        assert observation[-2] == pytest.approx(least) and total == pytest.approx(1.0 - least)
        if terminated or truncated:
            break
    assert (info["verdict"] == "fail") == terminated
    assert info["verdict"] == pc.Study("pedestrian-crossing", driver="cruise").test(info["test"])["verdict"]


def threads() -> int:
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("Threads:"))


@pytest.mark.skipif(not os.path.exists("/proc/self/status"), reason="nothing counts the threads here")
def test_an_episode_that_nobody_ends_leaves_no_thread():
    before = threads()
    environment = pg.DrivingEnv("cut-in")
    for seed in range(20):
        environment.reset(seed=seed)
        environment.step(np.zeros(2))
    environment.close()
    del environment
    gc.collect()
    for _ in range(100):
        if threads() <= before:
            return
        time.sleep(0.05)
    raise AssertionError(f"{threads()} threads, {before} before")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: pg.DrivingEnv("cut-inn"), "did you mean `cut-in`"),
        (lambda: pg.DrivingEnv("cut-in", others=-1), "others is -1"),
        (lambda: pg.DrivingEnv("cut-in", period=0.0).reset(), "period"),
        (lambda: pg.DrivingEnv("cut-in").step(np.zeros(2)), "call `reset` first"),
        (lambda: pg.DrivingEnv("cut-in").reset(options={"tests": {}}), r"found the options \['tests'\]"),
        (lambda: pg.DrivingEnv("cut-in").reset(options={"test": {"gap": 3.0}}), "gap|missing|no value"),
        (lambda: pg.DrivingEnv("cut-in", driver_command="x"), "no choice `driver_command`; the choices of a study that it has are open"),
        (lambda: pg.DrivingEnv("cut-in", budget=10), "no choice `budget`"),
        (lambda: pg.DrivingEnv("cut-in", cameras={"state": pc.Camera()}), "a camera is called `state`"),
        (lambda: pg.DrivingEnv("cut-in", look="textured"), "look is 'textured', but there are no cameras"),
        (lambda: pg.DrivingEnv("cut-in").reset(options={"test": 5}), "the test is 5, expected a dictionary"),
        (lambda: pg.DrivingVectorEnv(0), "num_envs is 0"),
        (lambda: pg.DrivingVectorEnv(2).reset(seed=[1]), "found 1 seeds, expected 2"),
        (lambda: pg.AdversaryEnv("cut-in", tests=-1), "tests is -1"),
        (lambda: pg.AdversaryEnv("cut-in", strategy="halton"), "no choice `strategy`"),
        (lambda: pg.AdversaryEnv("cut-in").reset(options={"test": {}}), "expected none"),
        (lambda: pg.AdversaryEnv("cut-in", fix=dict(ego_speed=40.0, relative_speed=-20.0, gap=30.0, lateral_speed=1.0)), "no open parameter"),
    ],
)
def test_an_environment_that_cannot_be_is_an_error(make, message):
    with pytest.raises(pc.Error, match=message):
        made = make()
        raise AssertionError(made)


def test_an_episode_that_is_over_needs_a_reset():
    environment = pg.DrivingEnv("cut-in")
    play(environment, coast, seed=1)
    with pytest.raises(pc.Error, match="call `reset` first"):
        environment.step(np.zeros(2))
    adversary = pg.AdversaryEnv("cut-in", tests=1)
    adversary.reset()
    adversary.step(np.full(4, 0.5))
    with pytest.raises(pc.Error, match="call `reset` first"):
        adversary.step(np.full(4, 0.5))
    together = pg.DrivingVectorEnv(2)
    together.reset(seed=1)
    with pytest.raises(pc.Error, match=r"the shape \(3, 2\), expected \(2, 2\)"):
        together.step(np.zeros((3, 2)))


def test_a_bad_action_of_one_car_moves_no_car():
    together, again = pg.DrivingVectorEnv(2), pg.DrivingVectorEnv(2)
    for environment in (together, again):
        environment.reset(seed=1)
    with pytest.raises(pc.Error, match="expected two numbers"):
        together.step(np.array([[1.0, 0.0], [np.nan, 0.0]]))
    for _ in range(5):
        brake = np.tile([-1.0, 0.0], (2, 1))
        assert (together.step(brake)[0] == again.step(brake)[0]).all()


def test_a_program_ends_while_an_episode_runs_a_function_of_python(tmp_path):
    program = """
        import signal, threading
        import os
        import paracosm as pc, paracosm.gymnasium as pg

        going = False

        @pc.scenario
        def endless(s):
            s.interval("v", 0.0, 1.0)
            road = s.place(pc.RoadSegment(800.0))
            car = s.place(pc.AutonomousVehicle(road.on_lane(1, 10.0)).speed(16.7))

            def f(value):
                while going:
                    pass
                return value

            s.require("a", pc.never(car.speed().map(f) > 100.0))

        environment = pg.DrivingEnv(endless)
        environment.reset(seed=1)
        going = True
        threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        try:
            environment.step([0.0, 0.0])
        except KeyboardInterrupt:
            print("interrupted")
        other = pg.DrivingEnv(endless)
        going = False
        other.reset(seed=1)
        going = True
        other._drive.episode.answer(pc.Control(0.0, 0.0))
        print("leaving")
    """
    (tmp_path / "ends.py").write_text(textwrap.dedent(program))
    ran = subprocess.run([sys.executable, "-c", "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); import runpy; runpy.run_path('ends.py')"], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert (ran.returncode, ran.stdout) == (0, "interrupted\nleaving\n"), ran.stderr


def test_an_action_that_is_none_is_an_error_and_one_too_large_is_clipped():
    environment = pg.DrivingEnv("cut-in")
    environment.reset(seed=1)
    for action in (np.zeros(3), np.array([np.nan, 0.0]), np.zeros((1, 2))):
        with pytest.raises(pc.Error, match="expected two numbers"):
            environment.step(action)
    assert environment.step(np.array([9.0, 0.0]))[2:4] == (False, False)
