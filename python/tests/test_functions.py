"""Functions of Python as systems under test."""

import threading

import numpy as np
import paracosm as pc
import pytest

SPACE = pc.Space({"throttle": (0.0, 1.0), "gear": [1, 2, 3], "road": ["flat", "steep"]})


def disc(x):
    return float(np.hypot(x[0] - 0.8, x[1] - 0.3) - 0.05)


def car(test):
    time = np.arange(0, 10.01, 0.5)
    pull = test["throttle"] * test["gear"] - (0.5 if test["road"] == "steep" else 0.0)
    return {"time": time, "speed": np.maximum(0, pull) * time, "gear": np.full(len(time), test["gear"])}


@pytest.mark.parametrize("seed", range(5))
def test_a_search_finds_the_failures_of_a_function(seed):
    report = pc.falsify(disc, 2, budget=100, seed=seed)
    assert report.verdicts["fail"] > 0
    assert all(np.hypot(t.test["x1"] - 0.8, t.test["x2"] - 0.3) < 0.05 for t in report.failures)
    assert report.worst.robustness["robustness"] == min(report.trials["robustness.robustness"]) < 0


def test_a_formula_judges_the_trace_of_a_function():
    report = pc.falsify(car, SPACE, spec="always (speed < 25)", strategy="halton", budget=60)
    for trial in report:
        top = car(trial.test)["speed"].max()
        assert trial.verdict == ("fail" if top >= 25 else "pass")
        assert trial.robustness["spec-1"] == 25 - top
    assert 0 < len(report.failures) < 60
    assert report.failures[0].replay()["speed"].max() >= 25


def test_a_function_may_return_a_trace_or_the_robustness_of_requirements():
    two = pc.falsify(lambda x: {"left": x[0] - 0.5, "right": np.float32(0.75)}, 1, strategy="sobol", budget=8)
    assert [trial.robustness["right"] for trial in two] == [0.75] * 8
    assert {trial.verdict for trial in two} == {"pass", "fail"}
    traces = pc.falsify(lambda t: pc.Trace(car(t)), SPACE, spec="eventually (speed > 1)", strategy="halton", budget=12)
    assert len(traces) == 12


def test_several_threads_ask_a_function_and_nothing_depends_on_them(tmp_path):
    threads = set()

    def watched(test):
        threads.add(threading.get_ident())
        return car(test)

    study = pc.Study.of_function(watched, SPACE, name="car", spec="always (speed < 25)", strategy="auto", budget=40, seed=2)
    one, four = study.run(tmp_path / "one", executor=1), study.run(tmp_path / "four", executor=4)
    assert len(threads) > 1
    for name in ("trials.jsonl", "trials.csv", "campaign.json", "coverage.json"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "four" / name).read_bytes()
    assert one.verdicts == four.verdicts and study.scenario == "car"
    assert study.replace(budget=5).run(tmp_path / "five").verdicts["error"] == 0


WRONG = [
    (lambda test: 1 / 0, None, "ZeroDivisionError: division by zero (test_functions.py, line "),
    (lambda test: None, None, "the function returned a value of the type NoneType, expected a robustness"),
    (lambda test: float("nan"), None, "the robustness of `robustness` is not a number"),
    (lambda test: False, None, "the function returned False, expected a robustness"),
    (lambda test: {"safe": np.True_}, None, "returned no number for `safe`"),
    (lambda test: {}, None, "`robustness` is empty"),
    (lambda test: {"gap": "wide"}, None, "returned no number for `gap`"),
    (lambda test: {1: 2.0}, None, "TypeError"),
    (lambda test: 0.5, "always (x < 1)", "expected a trace for the --spec to judge"),
    (lambda test: {"time": [0, 1], "y": [1, 2]}, "always (x < 1)", "`x`"),
    (lambda test: {"time": [0, 1], "x": [1]}, "always (x < 1)", "`x` has 1 sample, expected 2"),
    (lambda test: {"time": [0, 1], "x": [1, float("nan")]}, "always (x < 1)", "`x` has no finite value"),
    (lambda test: car(test), None, "no formula judges it"),
]


@pytest.mark.parametrize(("function", "spec", "words"), WRONG, ids=[words for *_, words in WRONG])
def test_a_function_that_answers_rubbish_gives_errors_and_the_campaign_goes_on(function, spec, words):
    report = pc.falsify(function, SPACE, spec=spec, strategy="halton", budget=12)
    assert report.verdicts["error"] == 12
    assert words in report[0].error


def test_a_function_that_raises_an_exit_does_not_end_the_interpreter():
    def leaves(test):
        raise SystemExit(3)

    report = pc.falsify(leaves, 1, strategy="halton", budget=3)
    assert "SystemExit: 3" in report[0].error


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: pc.falsify(3, 2), "found 3, expected a function"),
        (lambda: pc.falsify(disc, 0), "at least one coordinate"),
        (lambda: pc.falsify(disc, "square"), "expected a Space, or a number of dimensions"),
        (lambda: pc.falsify(disc, 2, strategy="atuo"), "did you mean `auto`?"),
        (lambda: pc.falsify(disc, 2, spec="always (x <"), "found the end"),
        (lambda: pc.falsify(disc, 2, driver="aeb"), "disc"),
        (lambda: pc.falsify(disc, 2, fix={"x1": 1}), "the system `disc` is not a scenario"),
    ],
)
def test_a_wrong_search_is_an_exception(call, words):
    with pytest.raises(pc.Error) as caught:
        call()
    assert words in str(caught.value)


def test_a_folder_of_a_function_is_read_but_its_tests_cannot_run(tmp_path, fuzz):
    pc.falsify(car, SPACE, spec="always (speed < 25)", strategy="halton", budget=30, folder=tmp_path / "out")
    again = pc.load(tmp_path / "out", trust=True)
    assert again.verdicts["fail"] > 0
    with pytest.raises(pc.Error, match="`car` was a function of the program that ran the campaign"):
        again.failures[0].replay()
    replayed = fuzz("replay", "out", "0", "--trust")
    assert replayed.returncode == 2 and "`car` was a function" in replayed.stderr
    assert fuzz("map", "out", "-q").returncode in (0, 2)
    assert fuzz("trace", "out").returncode == 0
