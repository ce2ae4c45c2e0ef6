"""Tables of tests go into pandas, polars and readers of Arrow, and come back to the last bit."""

import numpy as np
import paracosm as pc
import pytest

SPACE = pc.Space(
    {
        "speed": pc.Interval(0.5, 10, unit="m/s"),
        "lanes": pc.Choice([2, 4, 6]),
        "friction": pc.Choice([0.3, 0.8]),
        "weather": ["fog", "sun"],
        "wind": pc.Interval(-1, 1, signal="piecewise-linear(2)"),
    }
)
TESTS = pc.sample(SPACE, 40, method="random", seed=2)
NAMES = ["speed", "lanes", "friction", "weather", "wind[0]", "wind[1]", "wind[2]"]


def test_a_table_has_a_column_for_each_coordinate():
    assert TESTS.columns == NAMES
    assert TESTS["speed"].dtype == TESTS["friction"].dtype == np.float64
    assert TESTS["lanes"].dtype == np.int64
    assert set(TESTS["weather"]) == {"fog", "sun"}
    assert len(TESTS) == 40 and TESTS[-1] == list(TESTS)[39]
    assert TESTS[3] == {name: TESTS[name][3] for name in NAMES}


def test_a_table_becomes_a_data_frame_and_comes_back():
    pandas = pytest.importorskip("pandas")
    frame = TESTS.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and list(frame.columns) == NAMES
    assert pc.coverage(frame, SPACE) == pc.coverage(TESTS)


def test_readers_of_arrow_take_a_table():
    arrow, polars = pytest.importorskip("pyarrow"), pytest.importorskip("polars")
    table = arrow.table(TESTS)
    assert table.column_names == NAMES and table.num_rows == 40
    for name in NAMES:
        assert table[name].to_pylist() == TESTS[name].tolist() == TESTS.to_polars()[name].to_list()
    assert pc.coverage(polars.DataFrame(TESTS), SPACE) == pc.coverage(TESTS)


def test_tests_can_be_a_dictionary_or_rows_of_values():
    columns = {name: TESTS[name] for name in reversed(NAMES)}
    assert pc.coverage(columns, SPACE) == pc.coverage(TESTS)
    numbers = pc.Space({"a": (0, 10), "b": [1, 2]})
    assert pc.coverage([[5, 1], [2.5, 2]], numbers) == pc.coverage({"a": [5, 2.5], "b": [1, 2]}, numbers)


@pytest.mark.parametrize("change", [np.asfortranarray, lambda x: x[::-1][::-1], lambda x: x.tolist(), lambda x: x.astype(">f8")])
def test_the_layout_of_an_array_does_not_matter(change):
    points = pc.sample(3, 30)
    assert pc.coverage(change(points)) == pc.coverage(points)


def test_points_of_a_smaller_type_are_taken_as_they_are():
    points = pc.sample(2, 16, method="sobol").astype(np.float32)
    assert float(pc.dispersion(points)) == float(pc.dispersion(points.astype(np.float64)))
    corners = np.array([[0, 1], [1, 0]])
    assert float(pc.dispersion(corners)) == 1.0


def test_a_generator_takes_the_tests_that_it_proposed():
    generator = pc.Generator(SPACE, "auto", budget=20, seed=0)
    told = 0
    while told < 12:
        tests = generator.ask(3)
        generator.tell(tests, [None, 0.5, -float("inf")][: len(tests)])
        told += len(tests)
    assert generator.method == "auto"


def test_a_generator_of_the_cube_gives_arrays_and_repeats_itself():
    def proposed():
        generator = pc.Generator(2, "bayes", budget=30, seed=4)
        points = []
        for _ in range(15):
            x = generator.ask()
            generator.tell(x, np.hypot(x[:, 0] - 0.2, x[:, 1] - 0.9) - 0.1)
            points.append(x)
        return np.concatenate(points)

    assert np.array_equal(proposed(), proposed())
