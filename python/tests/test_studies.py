"""Studies and their results: the folder is that of the program, byte for byte."""

import copy
import csv
import json
import math
import pickle
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import paracosm as pc
import pytest


def files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir()) if path.suffix not in (".lock",)}


CAMPAIGNS = [
    ({}, ["--budget", "40"]),
    ({"driver": "cruise", "strategy": "auto", "seed": 3}, ["--driver", "cruise", "--strategy", "auto", "--seed", "3", "--budget", "40"]),
    (
        {"open": {"friction": (0.3, 0.8), "lanes": [2, 4]}, "fix": {"distance": 20.0}, "k": 2, "spec": "always (car.speed < 16)"},
        "--open friction=0.3..0.8 --open lanes=2,4 --set distance=20 --k 2 --budget 40".split() + ["--spec", "always (car.speed < 16)"],
    ),
    (
        {"open": {"friction": pc.Interval(0.3, 0.8, signal="piecewise-linear(2)")}, "strategy": "sobol-owen", "seed": 1},
        "--open friction:piecewise-linear:2=0.3..0.8 --strategy sobol-owen --seed 1 --budget 40".split(),
    ),
]


@pytest.mark.parametrize(("choices", "options"), CAMPAIGNS)
def test_the_folder_of_a_study_is_that_of_the_program(fuzz, tmp_path, choices, options):
    ran = fuzz("run", "pedestrian-crossing", *options, "--out", "program", "-q")
    assert ran.returncode == 0, ran.stderr
    pc.Study("pedestrian-crossing", budget=40, **choices).run(tmp_path / "python", executor=2)
    assert files(tmp_path / "python") == files(tmp_path / "program")


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    study = pc.Study("pedestrian-crossing", driver="aeb", open={"friction": (0.3, 0.8), "lanes": [2, 4]}, budget=60, seed=1)
    return study.run(tmp_path_factory.mktemp("campaign") / "out")


def test_a_report_has_the_columns_of_the_table_of_trials(report):
    with (report.folder / "trials.csv").open(newline="") as file:
        header, *rows = list(csv.reader(file))
    table = report.trials
    assert set(table.columns) == set(header) and table.columns[:5] == header[:5]
    assert len(table) == len(rows) == len(report) == sum(report.verdicts.values()) == 60
    for name, column in zip(header, zip(*rows, strict=True), strict=True):
        for cell, value in zip(column, table[name], strict=True):
            if isinstance(value, str):
                assert cell == value, name
            elif value is None or (isinstance(value, float) and math.isnan(value)):
                assert cell == "", name
            else:
                assert float(cell) == value, name


def test_the_rows_of_the_trials_are_the_lines_of_the_log(report):
    lines = [json.loads(line) for line in (report.folder / "trials.jsonl").read_text().splitlines()]
    for line in lines:
        del line["study"]
    trials = report.trials
    assert list(trials) == lines == [trials[index] for index in range(60)] and trials[-1] == lines[-1]
    assert [trial.index for trial in report] == list(range(60))
    assert [(trial.metrics, trial.ticks) for trial in report] == [(line["metrics"], line["ticks"]) for line in lines]
    with pytest.raises(IndexError):
        trials[60]
    with pytest.raises(KeyError, match="did you mean `speed`"):
        trials["sped"]


def test_the_documentation_of_a_study_names_all_choices():
    with pytest.raises(pc.Error, match="the choices are (.*)$") as error:
        pc.Study(nothing=1)  # type: ignore[call-arg]
    choices = str(error.value).rpartition("the choices are ")[2].split(", ")
    assert len(choices) > 20 and [name for name in choices if f"`{name}`" not in (pc.Study.__doc__ or "")] == []


def test_a_study_runs_or_extends_the_tests_of_a_file(fuzz, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tests.csv").write_text("speed,distance\n2.0,20.0\n4.0,18.0\n")
    study = pc.Study("pedestrian-crossing", driver="aeb", budget=8)
    for option in ("tests", "extend"):
        report = study.run(option, **{option: "tests.csv"})
        budget = ("--budget", "8") if option == "extend" else ()
        there = fuzz("--driver", "aeb", *budget, f"--{option}", "tests.csv", "--out", f"{option}-there")
        assert there.returncode == 0, there.stderr
        assert (tmp_path / option / "trials.jsonl").read_bytes() == (tmp_path / f"{option}-there" / "trials.jsonl").read_bytes()
        assert len(report) == {"tests": 2, "extend": 8}[option]
    with pytest.raises(pc.Error, match="tests and extend exclude each other"):
        study.run(tmp_path / "both", tests=tmp_path / "tests.csv", extend=tmp_path / "tests.csv")
    with pytest.raises(pc.Error, match="no column"):
        (tmp_path / "other.csv").write_text("sped\n1\n")
        study.run(tmp_path / "other", tests=tmp_path / "other.csv")


def test_a_file_of_openscenario_has_an_ego_a_duration_and_ranges(fuzz, tmp_path):
    assert fuzz("cut-in", "--budget", "2", "--out", "logged", "-q").returncode == 0
    assert fuzz("export", "logged", "1", "--out", "written", "--ego-as", "controller").returncode == 0
    scenario = next((tmp_path / "written").glob("*.xosc"))
    pc.Study(scenario, duration=3.0).run(tmp_path / "short")
    assert json.loads((tmp_path / "short" / "campaign.json").read_text())["fixed"]["run_duration"] == 3.0
    with pytest.raises(pc.Error, match="Nobody"):
        pc.Study(scenario, ego="Nobody").run(tmp_path / "nobody")
    with pytest.raises(pc.Error, match="no open range with a step"):
        pc.Study(scenario, continuous=True)
    with pytest.raises(pc.Error, match="no.glb"):
        pc.Study("cut-in", models={"car": "no.glb"}, budget=2).run(tmp_path / "models")


def test_notes_of_the_programs_are_warnings(tmp_path):
    with pytest.warns(UserWarning, match="spec-1: .* counts at the beginning of a run alone"):
        pc.Study("cut-in", spec="car.speed < 50", budget=2).run(tmp_path / "out")
    with pytest.warns(UserWarning, match="no effect: fog"):
        pc.Study("cut-in", driver="cruise", open=["fog"], budget=2).run(tmp_path / "fog")


def test_a_failure_is_replayed_as_arrays(report):
    failing = report.failures
    assert failing and all(trial.verdict == "fail" for trial in failing)
    trial = failing[0]
    assert report[trial.index].test == trial.test and set(trial.test) == {"speed", "distance", "friction", "lanes"}
    assert isinstance(trial.test["lanes"], int)
    trace = trial.replay()
    assert trace.hash == trial.trace_hash
    assert trace["car.speed"].dtype == np.float64 and len(trace) == report.trials["ticks"][trial.index] + 1
    assert trial.robustness["no-collision"] < 0
    assert report.worst.verdict == "fail"


def test_a_folder_is_read_again(report):
    again = pc.load(report.folder)
    assert again.verdicts == report.verdicts and again.coverage == report.coverage and again.modes == report.modes
    assert again.effects == report.effects
    assert [trial.test for trial in again.failures] == [trial.test for trial in report.failures]
    assert again[-1].replay().hash == report[59].trace_hash


def test_further_questions_have_the_answers_of_the_program(report, fuzz, tmp_path):
    def told(*arguments):
        ran = fuzz(*arguments, "--format", "json", "-q")
        assert ran.returncode == 0, ran.stderr
        return json.loads(ran.stdout)

    folder, failing = str(report.folder), report.failures[0]
    assert failing.shrink() == told("shrink", folder, str(failing.index))
    assert failing.shrink(same_mode=True, budget=40) == told("shrink", folder, str(failing.index), "--same-mode", "--budget", "40")
    study = pc.Study("pedestrian-crossing", driver="aeb", open={"friction": (0.3, 0.8), "lanes": [2, 4]}, budget=60, seed=1)
    after = study.replace(driver="cruise").run(tmp_path / "after")
    assert report.diff(after) == told("diff", folder, "after")
    assert study.likelihood(budget=100, seed=3)["probability"] == told(
        "likelihood", "pedestrian-crossing", *"--open friction=0.3..0.8 --open lanes=2,4 --budget 100 --seed 3".split()
    )["probability"]
    blamed = report.blame(["rss"])
    shutil.copytree(folder, tmp_path / "copy")
    assert blamed == told("blame", "copy", "--driver", "rss")


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda report: report[[t.verdict for t in report].index("pass")].shrink(), "expected a failing test"),
        (lambda report: report.blame(["rs"]), "did you mean"),
        (lambda report: pc.Study().likelihood(method="monte"), "no method is called `monte`"),
        (lambda report: pc.Study().likelihood(confidence=2), "the confidence is 2"),
        (lambda report: pc.falsify(lambda x: 1.0, 1, strategy="halton", budget=3).blame(), "<lambda>"),
    ],
)
def test_a_question_that_has_no_answer_is_an_exception(report, call, words):
    with pytest.raises(pc.Error) as caught:
        call(report)
    assert words in str(caught.value)


def test_a_report_shows_itself_in_a_notebook_and_as_a_page(report, tmp_path):
    shown = report._repr_html_()
    assert "data:image/svg+xml;base64," in shown and "<svg" not in shown and "pedestrian-crossing" in shown
    modes = report.modes["modes"]
    assert modes and all(f"such as test {mode['representative']}: {mode['words']}" in shown for mode in modes)
    report.page(tmp_path / "report.html", max_mb=2)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.lstrip().lower().startswith("<!doctype html>") and len(page) < 2e6


def test_a_study_is_a_value():
    study = pc.Study("pedestrian-crossing", driver="aeb", budget=20)
    other = study.replace(budget=1000, open=["friction"], driver=None)
    assert study.choices == {"driver": "aeb", "budget": 20} and study.space.names == ["speed", "distance"]
    assert other.choices["budget"] == 1000 and other.space.names == ["speed", "distance", "friction"]
    assert study.replace(scenario="cut-in").scenario == "cut-in"
    domains = {"friction": (0.3, 0.8)}
    opened = pc.Study(open=domains)
    domains["lanes"] = [2]
    opened.choices["open"]["lanes"] = [4]
    assert opened.choices == {"open": {"friction": (0.3, 0.8)}}
    assert "no-collision" in study.requirements
    with pytest.raises(AttributeError):
        study.scenario = "cut-in"


def pull(test):
    return test["friction"] - 0.2


@pytest.mark.parametrize("again", [copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))])
def test_a_study_and_a_space_survive_a_pickle(again, tmp_path):
    space = pc.Space({"friction": pc.Interval(0.1, 0.8, distribution="beta:2,5"), "lanes": [2, 4]}, constraints=["lanes > 2 or friction > 0.3"])
    assert again(space) == space != pc.Space({"friction": (0.1, 0.8)})
    for number, study in enumerate([
        pc.Study("cut-in", driver="aeb", open={"friction": (0.3, 0.8)}, budget=12, seed=1),
        pc.Study.of_function(pull, space, name="pull", strategy="auto", budget=12),
        pc.Study.of_function(max, 2, strategy="halton", budget=5),
    ]):
        first, second = tmp_path / f"{number}-first", tmp_path / f"{number}-second"
        study.run(first)
        again(study).run(second)
        assert files(first) == files(second)


def test_a_function_that_cannot_be_pickled_says_so():
    study = pc.Study.of_function(lambda x: 1.0, 2, budget=5)
    with pytest.raises((pickle.PicklingError, AttributeError)):
        pickle.dumps(study)


def test_progress_is_told_and_its_exception_ends_the_campaign_with_all_tests_kept(tmp_path):
    seen = []
    study = pc.Study("pedestrian-crossing", budget=30)
    study.run(tmp_path / "whole", progress=lambda done, budget: seen.append((done, budget)))
    assert seen[-1] == (30, 30) and seen == sorted(seen)

    def fails(done, budget):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        study.run(tmp_path / "cut", progress=fails)
    resumed = study.run(tmp_path / "cut", resume=True)
    assert len(resumed) == 30
    assert files(tmp_path / "cut") == files(tmp_path / "whole")


def test_ctrl_c_keeps_the_tests_and_the_study_goes_on(tmp_path):
    script = (
        "import paracosm as pc\n"
        "study = pc.Study('pedestrian-crossing', budget=20000)\n"
        "study.run('out', progress=lambda done, budget: print(done, flush=True))\n"
    )
    running = subprocess.Popen([sys.executable, "-c", script], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert running.stdout is not None
    while int(running.stdout.readline()) < 10:
        pass
    running.send_signal(signal.SIGINT)
    _, errors = running.communicate(timeout=60)
    assert "KeyboardInterrupt" in errors
    kept = (tmp_path / "out" / "trials.jsonl").read_text().splitlines()
    assert 10 <= len(kept) < 20000


WRONG = [
    (lambda _: pc.Study("pedestrian-crosing"), "did you mean `pedestrian-crossing`?"),
    (lambda _: pc.Study(buget=3), "a study has no choice `buget` (did you mean `budget`?)"),
    (lambda _: pc.Study(budget=0), "budget"),
    (lambda _: pc.Study(budget="many"), "budget is 'many'"),
    (lambda _: pc.Study(budget=-1), "budget is -1"),
    (lambda _: pc.Study(driver="aebb"), "did you mean `aeb`?"),
    (lambda _: pc.Study(strategy="haltn"), "did you mean `halton`?"),
    (lambda _: pc.Study(open={"fricton": (0, 1)}), "did you mean `friction`?"),
    (lambda _: pc.Study(open={"friction": (0.5, 9.0)}), "friction"),
    (lambda _: pc.Study(fix={"friction": "ice"}), "friction"),
    (lambda _: pc.Study(fix={"friction": None}), "fix: parameter `friction`"),
    (lambda _: pc.Study(fix=3), "fix is 3, expected a dictionary"),
    (lambda _: pc.Study(driver_settings={"latency": "long"}), "driver_settings: `latency`"),
    (lambda _: pc.Study(spec="always (car.sped < 3)"), "did you mean `car.speed`?"),
    (lambda _: pc.Study(vehicle="joined"), "expected `single-track` or `jointed`"),
    (lambda _: pc.Study(discrete="random", delta=3), "delta is 3"),
    (lambda path: pc.Study(budget=2).run(path), "already"),
    (lambda path: pc.load(path / "nothing"), "nothing"),
]


@pytest.mark.parametrize(("call", "words"), WRONG, ids=[words for _, words in WRONG])
def test_a_wrong_study_is_an_exception_that_says_what_was_expected(call, words, tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    pc.Study(budget=2).run(tmp_path / "done")
    with pytest.raises(pc.Error) as caught:
        call(tmp_path / "done" if "already" in words else tmp_path)
    assert words in str(caught.value)


DRIVER = """
import pathlib
import paracosm

pathlib.Path("ran").touch()


class Cruise(paracosm.Driver):
    def step(self, observation):
        return paracosm.Control()


Cruise().serve()
"""


def test_a_folder_of_a_stranger_runs_no_command(tmp_path, monkeypatch):
    pytest.importorskip("grpc")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "driver.py").write_text(DRIVER)
    ran = pc.Study(driver_command=f"{sys.executable} driver.py", budget=2).run("out")
    assert ran[0].replay().hash == ran[0].trace_hash
    (tmp_path / "ran").unlink()
    with pytest.raises(pc.Error, match="driver.py"):
        pc.load("out")[0].replay()
    assert not (tmp_path / "ran").exists()
    assert pc.load("out", trust=True)[0].replay().hash == ran[0].trace_hash
