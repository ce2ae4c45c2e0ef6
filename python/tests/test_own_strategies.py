"""Samplers and searches of other packages as strategies of a study, and what happens to those that go wrong."""

import json
import warnings
from typing import Any

import numpy as np
import paracosm as pc
import pytest
from paracosm import qmc

SPACE = pc.Space({"x": pc.Interval(-1.0, 1.0), "y": pc.Interval(-1.0, 1.0)})
MIXED = pc.Space({"x": pc.Interval(-1.0, 1.0), "n": pc.Choice([2, 4, 6])})


def bowl(test: dict[str, float]) -> float:
    """Fails near (0.5, -0.25)."""
    return (test["x"] - 0.5) ** 2 + (test["y"] + 0.25) ** 2 - 0.01


class Walk:
    """Steps around the best point so far, and writes down what it is told."""

    def __init__(self, seed: int = 0) -> None:
        self.rng = np.random.default_rng(seed)
        self.best = (np.inf, np.array([0.5, 0.5]))
        self.told: list[tuple[np.ndarray, np.ndarray]] = []

    def ask(self, n: int) -> np.ndarray:
        return np.clip(self.best[1] + 0.2 * self.rng.normal(size=(n, 2)), 0.0, 1.0)

    def tell(self, X: np.ndarray, y: np.ndarray) -> None:
        self.told.append((X, y))
        for point, value in zip(X, y):
            if value < self.best[0]:
                self.best = (value, point)


def table_of(report: pc.Report) -> np.ndarray:
    frame = report.trials.to_pandas()
    return frame[["x", "y"]].to_numpy()


def test_a_search_of_a_user_finds_failures_and_stays_as_it_was(tmp_path):
    walk = Walk(seed=1)
    report = pc.falsify(bowl, SPACE, strategy=walk, budget=200, folder=tmp_path / "out")
    assert report.verdicts["fail"] > 0 and walk.told == []
    campaign = json.loads((tmp_path / "out" / "campaign.json").read_text())
    assert (campaign["strategy"], campaign["own_strategy"]) == ("own", "Walk")
    again = pc.falsify(bowl, SPACE, strategy=walk, budget=200)
    assert (table_of(report) == table_of(again)).all()


def test_a_search_is_told_all_results_of_a_batch_in_order():
    known: list[tuple[np.ndarray, np.ndarray]] = []

    class Watched(Walk):
        def tell(self, X: np.ndarray, y: np.ndarray) -> None:
            known.append((X, y))

        def __deepcopy__(self, memo: Any) -> "Watched":
            return Watched()

    def sometimes(test: dict[str, float]) -> float:
        if test["x"] > 0.2:
            raise ValueError("it broke")
        return test["x"] + 10 * test["y"]

    report = pc.falsify(sometimes, SPACE, strategy=Watched(), budget=21, batch=7)
    assert [len(X) for X, _ in known] == [7, 7, 7]
    points, values = np.vstack([X for X, _ in known]), np.concatenate([y for _, y in known])
    frame = report.trials.to_pandas()
    assert np.allclose(2 * points - 1, frame[["x", "y"]].to_numpy())
    broken = frame["verdict"] == "error"
    assert broken.any() and (np.isnan(values) == broken).all()


def test_a_campaign_with_an_own_search_goes_on_where_it_was_interrupted(tmp_path):
    study = pc.Study.of_function(bowl, SPACE, strategy=Walk(seed=3), budget=60)
    whole = study.run(tmp_path / "whole")
    study.run(tmp_path / "part")
    log = tmp_path / "part" / "trials.jsonl"
    lines = log.read_text().splitlines(keepends=True)
    log.write_text("".join(lines[:25]))
    for file in ("coverage.json", "summary.json"):
        (tmp_path / "part" / file).unlink(missing_ok=True)
    study.run(tmp_path / "part", resume=True)
    assert log.read_text() == (tmp_path / "whole" / "trials.jsonl").read_text() and len(whole) == 60


@pytest.mark.parametrize(
    "strategy",
    [qmc.Halton(2), qmc.Halton, lambda d, seed: qmc.Halton(d)],
    ids=["object", "class", "function"],
)
def test_an_engine_gives_the_tests_of_its_strategy(strategy):
    ours = table_of(pc.falsify(bowl, SPACE, strategy="halton", budget=40))
    assert (table_of(pc.falsify(bowl, SPACE, strategy=strategy, budget=40)) == ours).all()


def test_the_engines_of_scipy_are_strategies():
    scipy_qmc = pytest.importorskip("scipy.stats.qmc")
    report = pc.falsify(bowl, SPACE, strategy=scipy_qmc.Sobol(2, rng=1), budget=32, batch=32)
    expected = 2 * scipy_qmc.Sobol(2, rng=1).random(32) - 1
    assert np.allclose(table_of(report), expected)


def test_a_function_gets_the_seed_of_the_study():
    seeds = []

    def made(d: int, rng: int | None) -> qmc.Random:
        seeds.append((d, rng))
        return qmc.Random(d, rng=rng)

    pc.falsify(bowl, SPACE, strategy=made, budget=8, seed=5)
    assert set(seeds) == {(2, 5)}


@pytest.mark.parametrize("name", ["TPESampler", "QMCSampler", "NSGAIISampler"])
def test_the_samplers_of_optuna_are_strategies(name):
    optuna = pytest.importorskip("optuna")
    sampler = getattr(optuna.samplers, name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        first = pc.falsify(bowl, SPACE, strategy=sampler(seed=1), budget=80, batch=1)
        again = pc.falsify(bowl, SPACE, strategy=sampler(seed=1), budget=80, batch=1)
        mixed = pc.falsify(lambda test: test["x"] + test["n"], MIXED, strategy=sampler(seed=1), budget=40, batch=1)
    assert (table_of(first) == table_of(again)).all()
    assert set(mixed.trials.to_pandas()["n"]) == {2, 4, 6}
    if name == "TPESampler":
        frame = first.trials.to_pandas()
        assert frame["robustness.robustness"][40:].mean() < frame["robustness.robustness"][:40].mean()


def test_a_grid_of_optuna_ends_its_campaign_with_its_last_point():
    optuna = pytest.importorskip("optuna")
    corners = {"x0": [0.0, 0.5, 1.0], "x1": [0.0, 1.0]}
    report = pc.falsify(bowl, SPACE, strategy=optuna.samplers.GridSampler(corners, seed=1), budget=50, batch=1)
    assert np.allclose(sorted(map(tuple, table_of(report))), [(x, y) for x in (-1.0, 0.0, 1.0) for y in (-1.0, 1.0)])


@pytest.mark.parametrize("is_made", [False, True], ids=["object", "function"])
@pytest.mark.parametrize("constraints", [[], ["x + y < 1"], ["x > 0.9"]])
def test_pycma_gets_whole_generations_whatever_the_budget(is_made, constraints):
    cma = pytest.importorskip("cma")
    space = pc.Space({"x": pc.Interval(-1.0, 1.0), "y": pc.Interval(-1.0, 1.0)}, constraints=constraints)

    def made(d: int, seed: int) -> Any:
        return cma.CMAEvolutionStrategy(d * [0.1], 0.3, {"bounds": [0, 1], "seed": seed, "verbose": -9})

    for budget in (62, 100, 240):
        strategy = made if is_made else made(2, 1)
        frame = pc.falsify(bowl, space, strategy=strategy, budget=budget, seed=1).trials.to_pandas()
        assert len(frame) == budget
        if budget == 240 and constraints != ["x > 0.9"]:
            assert frame["robustness.robustness"][120:].min() < 0 and frame["robustness.robustness"][200:].median() < 0.05


def test_a_search_is_asked_again_only_after_all_results():
    calls: list[str] = []

    class Strict(Walk):
        popsize = 5

        def __deepcopy__(self, memo: Any) -> "Strict":
            return Strict()

        def ask(self, n: int) -> np.ndarray:
            calls.append(f"ask {n}")
            return super().ask(n)

        def tell(self, X: np.ndarray, y: np.ndarray) -> None:
            calls.append(f"tell {len(X)}")
            super().tell(X, y)

    space = pc.Space({"x": pc.Interval(-1.0, 1.0), "y": pc.Interval(-1.0, 1.0)}, constraints=["x < 0.2"])
    assert len(pc.falsify(bowl, space, strategy=Strict(), budget=33)) == 33
    assert len(calls) > 10 and set(calls[0::2]) == {"ask 5"} and set(calls[1::2]) == {"tell 5"}


def test_tests_that_break_a_constraint_are_left_out():
    space = pc.Space({"x": pc.Interval(-1.0, 1.0), "y": pc.Interval(-1.0, 1.0)}, constraints=["x > y"])
    frame = pc.falsify(bowl, space, strategy=Walk(seed=2), budget=50).trials.to_pandas()
    assert len(frame) == 50 and (frame["x"] > frame["y"]).all()


def test_a_search_that_never_proposes_a_valid_test_is_an_error():
    space = pc.Space({"x": pc.Interval(-1.0, 1.0), "y": pc.Interval(-1.0, 1.0)}, constraints=["x > 0.5"])

    class Stubborn(Walk):
        def ask(self, n: int) -> np.ndarray:
            return np.full((n, 2), 0.5)

    with pytest.raises(pc.Error, match="the strategy `Stubborn`: [0-9]+ points in a row break a constraint"):
        pc.falsify(bowl, space, strategy=Stubborn(), budget=20)


def test_another_search_cannot_continue_a_campaign(tmp_path):
    study = pc.Study.of_function(bowl, SPACE, strategy=Walk(seed=3), budget=40)
    with pytest.raises(RuntimeError):
        study.run(tmp_path / "out", progress=stopping, executor=1)
    with pytest.raises(pc.Error, match="give the strategy `Walk` as before"):
        study.replace(strategy=Walk(seed=4)).run(tmp_path / "out", resume=True)


def stopping(done: int, budget: int) -> None:
    if done:
        raise RuntimeError("enough")


class Broken(Walk):
    def __init__(self, found: Any) -> None:
        super().__init__()
        self.found = found

    def ask(self, n: int) -> Any:
        return self.found(n)


def raises(n: int) -> Any:
    raise RuntimeError("no idea")


@pytest.mark.parametrize(
    ("strategy", "message"),
    [
        (Broken(lambda n: np.zeros((n, 3))), r"the shape \(16, 3\), expected \(16, 2\)"),
        (Broken(lambda n: np.zeros(n)), r"the shape \(16,\), expected \(16, 2\)"),
        (Broken(lambda n: np.full((n, 2), 1.5)), "1.5 as coordinate 1 of point 1, expected a number from 0 to 1"),
        (Broken(lambda n: np.full((n, 2), np.nan)), "nan as coordinate 1 of point 1"),
        (Broken(lambda n: np.zeros((n + 1, 2))), "returned 17 points, expected at most 16"),
        (Broken(lambda n: [["a", "b"]]), "could not convert"),
        (Broken(raises), r"RuntimeError: no idea \(test_own_strategies.py, line"),
        (Broken(lambda n: np.full((n, 2), 0.5 + 0.1j)), "complex or masked numbers"),
        (Broken(lambda n: []), r"ask\(16\) returned no points"),
        (lambda d: 3, "the function made int, expected an object with"),
        (lambda: Walk(), "takes 0 positional arguments"),
        (3, "strategy is 3, expected the name of a strategy"),
    ],
)
def test_a_strategy_that_goes_wrong_is_an_error(strategy, message, tmp_path):
    with pytest.raises(pc.Error, match=message):
        pc.falsify(bowl, SPACE, strategy=strategy, budget=20, folder=tmp_path / "out")


def test_a_search_that_breaks_later_loses_no_test(tmp_path):
    class Tired(Walk):
        def tell(self, X: np.ndarray, y: np.ndarray) -> None:
            super().tell(X, y)
            if len(self.told) == 2:
                raise RuntimeError("too tired")

    with pytest.raises(pc.Error, match="the strategy `Tired`: RuntimeError: too tired"):
        pc.falsify(bowl, SPACE, strategy=Tired(), budget=80, folder=tmp_path / "out")
    assert len((tmp_path / "out" / "trials.jsonl").read_text().splitlines()) == 32
    assert len(pc.falsify(bowl, SPACE, strategy=Tired(), budget=32)) == 32


def test_an_object_that_cannot_be_copied_is_an_error():
    import threading

    class Locked(Walk):
        def __init__(self) -> None:
            super().__init__()
            self.lock = threading.Lock()

    for choices in ({"strategy": Locked()}, {"strategy": lambda d: Locked()}):
        if callable(choices["strategy"]):
            assert len(pc.falsify(bowl, SPACE, budget=4, **choices)) == 4
        else:
            with pytest.raises(pc.Error, match="cannot be copied"):
                pc.falsify(bowl, SPACE, budget=4, **choices)


def test_a_folder_can_be_read_without_its_strategy(tmp_path, fuzz):
    pc.Study("cut-in", strategy=qmc.Greedy, budget=4).run(tmp_path / "out")
    report = pc.load(tmp_path / "out")
    assert len(report[0].replay()["time"]) > 1
    assert fuzz("report", str(tmp_path / "out")).returncode == 0
    resumed = fuzz("resume", str(tmp_path / "out"))
    assert resumed.returncode != 0 or "complete" in resumed.stdout + resumed.stderr
    named = fuzz("cut-in", "--strategy", "own", "--budget", "3")
    assert named.returncode == 2 and "only a program can give" in named.stderr
