"""The script that compares searches on requirements of a benchmark."""

import csv
import subprocess
import sys
from pathlib import Path

import pytest

for needed in ("tomllib", "cma", "optuna", "scipy"):
    pytest.importorskip(needed)

FOLDER = Path(__file__).parents[2] / "experiments" / "searchers"

# It answers as a system does, and fails where the first throttle is high and the last brake is low.
SYSTEM = """\
#!{python}
import json, sys
assert sys.argv[1:4] == ["system", "automatic-transmission", "--spec"]
for line in sys.stdin:
    test = json.loads(line)["test"]
    worth = max(0.8 - test["throttle"][0] / 100, test["brake"][4] / 325 - 0.2)
    print(json.dumps({{"index": 0, "robustness": {{"spec": worth}}}}), flush=True)
"""


@pytest.fixture
def system(tmp_path: Path) -> Path:
    path = tmp_path / "system"
    path.write_text(SYSTEM.format(python=sys.executable))
    path.chmod(0o755)
    return path


def compare(system: Path, out: Path, *arguments: str) -> list[dict[str, str]]:
    command = [sys.executable, FOLDER / "compare.py", system, out, "--requirement", "AT1", "--jobs", "2", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return list(csv.DictReader(out.open()))


def test_every_search_finds_an_easy_failure_or_spends_its_budget(system: Path, tmp_path: Path) -> None:
    names = ["auto", "random", "optuna-tpe", "pycma", "scipy-de", "scipy-dual-annealing"]
    chosen = [argument for name in names for argument in ("--search", name)]
    rows = compare(system, tmp_path / "runs.csv", "--seeds", "2", "--budget", "150", *chosen)
    assert [(row["search"], row["seed"]) for row in rows] == [(name, seed) for name in names for seed in "01"]
    assert all(row["tests"] == "" or 1 <= int(row["tests"]) <= 150 for row in rows)
    # Four in a hundred tests fail: of twelve runs of 150 tests, one without a failure is rare.
    assert sum(row["tests"] != "" for row in rows) >= 10


@pytest.mark.parametrize("name", ["verifai-ce", "verifai-mab", "bayes-opt"])
def test_a_search_of_a_package_that_the_gate_lacks_runs_where_it_is_installed(name: str, system: Path, tmp_path: Path) -> None:
    pytest.importorskip("bayes_opt" if name == "bayes-opt" else "verifai")
    assert len(compare(system, tmp_path / "runs.csv", "--seeds", "1", "--budget", "20", "--search", name)) == 1


def test_runs_that_the_file_has_are_not_made_again(system: Path, tmp_path: Path) -> None:
    out = tmp_path / "runs.csv"
    one = ("--search", "random", "--budget", "40")
    first = compare(system, out, "--seeds", "2", *one)
    # The last line of a file may be cut short by a crash.
    text = out.read_text().replace(f"random,1,40,{first[1]['tests']}\n", "random,1,40,7\n")
    out.write_text(text + "AT1,random,2,4")
    again = compare(system, out, "--seeds", "3", *one)
    assert again[:2] == [first[0], {**first[1], "tests": "7"}] and len(again) == 3


def test_the_controls_repeat_with_the_same_seed(system: Path, tmp_path: Path) -> None:
    one = ("--search", "auto", "--search", "random-corners", "--seeds", "2", "--budget", "40")
    assert compare(system, tmp_path / "a.csv", *one) == compare(system, tmp_path / "b.csv", *one)
