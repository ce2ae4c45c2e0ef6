"""Python and the programs give the same numbers, to the last bit."""

import csv
import io
from pathlib import Path

import numpy as np
import paracosm as pc
import pytest

OPEN_LOOP = [name for name, _, is_adaptive in pc.strategies() if not is_adaptive and name not in ("given", "fibonacci")]

SPACE = """
constraints = ["lanes > 2 or speed < 5"]

[[parameter]]
name = "speed"
interval = [0.5, 10.0]
unit = "m/s"

[[parameter]]
name = "gap"
interval = [5.0, 60.0]

[[parameter]]
name = "lanes"
choice = [2, 4, 6]

[[parameter]]
name = "weather"
choice = ["sun", "fog", "rain"]
"""


def points_of(text):
    rows = list(csv.reader(io.StringIO(text)))
    return np.array([[float(cell) for cell in row] for row in rows[1:]])


@pytest.mark.parametrize("method", OPEN_LOOP)
@pytest.mark.parametrize("seed", [None, 7])
def test_a_sample_of_the_cube_is_the_set_of_the_program(cover, method, seed):
    seeds = [] if seed is None else ["--seed", str(seed)]
    expected = points_of(cover("generate", "--dims", "3", "--strategy", method, "--budget", "40", *seeds))
    found = pc.sample(3, 40, method=method, seed=seed)
    assert found.shape == (40, 3) and found.dtype == np.float64
    assert np.array_equal(found, expected)


@pytest.mark.parametrize("method", OPEN_LOOP)
def test_a_sample_of_a_mixed_space_is_the_set_of_the_program(cover, tmp_path: Path, method):
    file = tmp_path / "space.toml"
    file.write_text(SPACE)
    text = cover("generate", "--space", str(file), "--strategy", method, "--budget", "36", "--seed", "3")
    rows = list(csv.DictReader(io.StringIO(text)))
    found = pc.sample(pc.Space.read(file), 36, method=method, seed=3)
    assert len(found) == len(rows) > 0
    for test, row in zip(found, rows, strict=True):
        assert test["weather"] == row["weather"]
        assert [test[name] for name in ("speed", "gap", "lanes")] == [float(row[name]) for name in ("speed", "gap", "lanes")]


@pytest.mark.parametrize("epsilon", [0.2, 0.1])
def test_a_sample_reaches_epsilon_with_as_many_tests_as_the_program(cover, epsilon):
    expected = points_of(cover("generate", "--dims", "2", "--strategy", "greedy", "--epsilon", str(epsilon)))
    found = pc.sample(2, method="greedy", epsilon=epsilon)
    assert np.array_equal(found, expected)
    assert pc.dispersion(found).upper <= epsilon


def test_a_sample_completes_existing_tests_as_the_program_does(cover, tmp_path: Path):
    existing = pc.sample(2, 5, method="random", seed=1)
    file = tmp_path / "points.csv"
    np.savetxt(file, existing, delimiter=",", fmt="%.17g")
    expected = points_of(cover("generate", "--extend", str(file), "--budget", "6"))
    assert np.array_equal(pc.sample(2, 6, method="greedy", existing=existing), expected)


@pytest.mark.parametrize("dims", [1, 2, 4])
def test_every_measure_of_points_is_the_number_of_the_program(estimate, tmp_path: Path, dims):
    points = pc.sample(dims, 50, method="lhs", seed=dims)
    file = tmp_path / "points.csv"
    np.savetxt(file, points, delimiter=",", fmt="%.17g")
    assert pc.coverage(points) == estimate(str(file))


def test_every_measure_of_a_mixed_space_is_the_number_of_the_program(cover, estimate, tmp_path: Path):
    space, tests = tmp_path / "space.toml", tmp_path / "tests.csv"
    space.write_text(SPACE)
    tests.write_text(cover("generate", "--space", str(space), "--budget", "30"))
    expected = estimate(str(tests), "--space", str(space), "--k", "2")
    assert pc.coverage(pc.sample(pc.Space.read(space), 30), k=2) == expected


def test_there_is_a_function_for_every_measure():
    points = pc.sample(2, 20)
    functions = {
        "dispersion": pc.dispersion,
        "star": pc.star_discrepancy,
        "extreme": pc.extreme_discrepancy,
        "fill": pc.fill_distance,
        "l2-star": pc.l2_star_discrepancy,
        "centered": pc.centered_discrepancy,
        "wraparound": pc.wraparound_discrepancy,
        "mixture": pc.mixture_discrepancy,
        "k-wise-dispersion": pc.k_wise_dispersion,
    }
    assert set(functions) | {"k-wise"} == {name for name, _ in pc.measures()}
    keys = {"star": "star_discrepancy", "fill": "fill_distance"}
    found = pc.coverage(points)
    for name, function in functions.items():
        bracket = function(points)
        assert bracket.exact and bracket.lower == bracket.upper == float(bracket), name
        part = found["k_wise_dispersion"] if name == "k-wise-dispersion" else _named(found["continuous"], name, keys)
        assert _number(part) == float(bracket), name


def _named(continuous, name, keys):
    places = [key for key in continuous if key == keys.get(name) or key.startswith(name.replace("-", "_"))]
    assert len(places) == 1, (name, list(continuous))
    return continuous[places[0]]


def _number(part):
    if isinstance(part, dict):
        return next(part[key] for key in ("value", "volume", "radius", "lower") if key in part)
    return part


def test_a_covering_array_covers_the_discrete_parameters_of_a_mixed_space():
    choices = {"lanes": pc.Choice([2, 4, 6]), "sky": pc.Choice(["clear", "rain"])}
    rules = ["lanes > 2 or sky == 'clear'", "lanes > 2 or speed < 5"]
    space = pc.Space({"speed": pc.Interval(0.5, 10, unit="m/s"), **choices}, constraints=rules)
    array = pc.covering_array(space, k=2)
    assert list(array) == list(pc.covering_array(pc.Space(choices, constraints=rules[:1]), k=2))
    assert array.columns == ["lanes", "sky"] and len(array) == 5
    with pytest.warns(UserWarning, match="k is 3, but only 2 parameters are discrete"):
        assert pc.covering_array(space, k=3).k == 2
    with pytest.warns(UserWarning, match="k is 3, but only 2 parameters are discrete"):
        pc.plan(space, k=3, epsilon=0.5)


def test_a_covering_array_has_the_rows_of_the_program(cover, tmp_path: Path):
    model = tmp_path / "model.pict"
    model.write_text("A: 1, 2, 3\nB: x, y, z\nC: on, off\nD: 1, 2, 3, 4\nIF [A] = 1 THEN [C] = \"on\";\n")
    rows = list(csv.DictReader(io.StringIO(cover("generate", "--space", str(model), "--k", "2"))))
    array = pc.covering_array(pc.Space.read(model), k=2)
    assert array.k == 2 and array.lower_bound <= len(array) == len(rows)
    assert [{name: str(value) for name, value in row.items()} for row in array] == rows
    assert float(pc.k_wise_coverage(array, k=2)) == 1.0


def test_a_plan_is_the_plan_of_the_program(cover, tmp_path: Path):
    import json

    file = tmp_path / "space.toml"
    file.write_text(SPACE.replace('constraints = ["lanes > 2 or speed < 5"]', ""))
    expected = json.loads(cover("plan", "--space", str(file), "--k", "2", "--epsilon", "0.2", "--format", "json"))
    assert pc.plan(pc.Space.read(file), k=2, epsilon=0.2) == expected


def test_measures_agree_with_scipy():
    qmc = pytest.importorskip("scipy.stats").qmc
    points = pc.sample(3, 64, method="sobol", seed=5)
    assert float(pc.centered_discrepancy(points)) == pytest.approx(qmc.discrepancy(points, method="CD"), rel=1e-12)
    assert float(pc.wraparound_discrepancy(points)) == pytest.approx(qmc.discrepancy(points, method="WD"), rel=1e-12)
    assert float(pc.mixture_discrepancy(points)) == pytest.approx(qmc.discrepancy(points, method="MD"), rel=1e-12)
