"""Bad input is an exception with a message for people. The interpreter goes on."""

import warnings

import numpy as np
import paracosm as pc
import pytest

SPACE = pc.Space({"speed": (0.5, 10), "lanes": [2, 4, 6]})
NAN = float("nan")
LOOP: list = []
LOOP.append(LOOP)

WRONG = [
    (lambda: pc.dispersion([1, 2]), "has the shape (2,), expected (n, d)"),
    (lambda: pc.dispersion(np.zeros((2, 2, 2))), "has the shape (2, 2, 2), expected (n, d)"),
    (lambda: pc.dispersion([[0.5, NAN]]), "point 0, coordinate 1: found NaN, expected a number in [0, 1]"),
    (lambda: pc.dispersion([[0.5, 0.5], [0.5, 1.5]]), "point 1, coordinate 1: found 1.5"),
    (lambda: pc.dispersion([["a"]]), "has the dtype <U1, expected numbers"),
    (lambda: pc.dispersion([[1j]]), "has the dtype complex128"),
    (lambda: pc.dispersion([[1, 2], [3]]), "inhomogeneous shape"),
    (lambda: pc.dispersion(np.zeros((3, 0))), "at least one coordinate"),
    (lambda: pc.dispersion(None), "the array of points"),
    (lambda: pc.dispersion([[0.5]], time_limit=-1), "time_limit is -1, expected a number of seconds"),
    (lambda: float(pc.dispersion(pc.sample(8, 300), time_limit=0.0)), "use .lower or .upper"),
    (lambda: pc.k_wise_dispersion([[0.5, 0.5]], k=3), "k is 3, expected 1 to 2"),
    (lambda: pc.k_wise_coverage([[0.5, 0.5]]), "the space has no discrete parameters"),
    (lambda: pc.coverage([[0.5]], measures=["dispersio"]), "did you mean `dispersion`?"),
    (lambda: pc.coverage({"speed": [1]}, SPACE), "no column is called `lanes`"),
    (lambda: pc.coverage({"speed": [1, 2], "lanes": [2]}, SPACE), "column `lanes` has 1 values, expected 2"),
    (lambda: pc.coverage({"speed": [1], "lanes": [3]}, SPACE), "row 0: parameter `lanes`"),
    (lambda: pc.coverage({"speed": ["fast"], "lanes": [2]}, SPACE), "row 0: parameter `speed`"),
    (lambda: pc.coverage({"speed": [True], "lanes": [2]}, SPACE), "column `speed`: found True, expected a number or a word"),
    (lambda: pc.coverage(pc.sample(SPACE, 3), pc.Space({"a": (0, 1)})), "belong to another space"),
    (lambda: pc.sample(3), "the number of tests is missing"),
    (lambda: pc.sample(0, 5), "at least one coordinate"),
    (lambda: pc.sample("halton", 5), "expected a Space, or a number of dimensions"),
    (lambda: pc.sample(10**9, 10**9), "do not fit in memory"),
    (lambda: pc.sample(10, 10**9), "do not fit in memory"),
    (lambda: pc.sample(3, 5, method="haltom"), "did you mean `halton`?"),
    (lambda: pc.sample(3, 5, method="bayes"), "use Generator(space, \"bayes\")"),
    (lambda: pc.sample(3, -2), "found -2, expected a whole number from 0 on"),
    (lambda: pc.sample(3, 10**30), "expected a whole number up to 18446744073709551615"),
    (lambda: pc.Study("cut-in", budget=-1), "budget is -1, expected a whole number from 0 on"),
    (lambda: pc.Study("cut-in", seed=True), "seed is True, expected a whole number from 0 on"),
    (lambda: pc.Study("cut-in").likelihood(seed=-1), "found -1, expected a whole number from 0 on"),
    (lambda: pc.sample(3, 0), "a budget must be at least 1"),
    (lambda: pc.sample(3, 5, existing=[[0.5, 0.5]], method="greedy"), "the points have 2 coordinates, expected 3"),
    (lambda: pc.Generator(2, "bayes").tell([[0.5, 0.5]], [1, 2]), "found 2 values of robustness, expected 1"),
    (lambda: pc.Generator(2, "bayes").tell([[0.5, 0.5]], "x"), "the robustness"),
    (lambda: pc.Space(3), "a space is made of a dictionary"),
    (lambda: pc.Space({"a": (3, 1)}), "found the interval [3, 1]"),
    (lambda: pc.Space({"a": (1, 2, 3)}), "found a tuple of 3, expected (low, high)"),
    (lambda: pc.Space({"a": "x"}), "expected Interval(low, high)"),
    (lambda: pc.Space({"a": [object()]}), "found a value of the type object"),
    (lambda: pc.Space({"a": pc.Interval(0, 1, signal="polynom(2)")}), "did you mean `polynomial`?"),
    (lambda: pc.Space({"a": pc.Interval(0, 1, distribution="norml:0,1")}), "norml"),
    (lambda: pc.Space({"a": [1, 2]}, constraints=["b > 2"]), "no parameter is called `b`"),
    (lambda: pc.Space({"a": [1, 2]}, constraints=["a > 2"]), "no test keeps this constraint"),
    (lambda: pc.Space({"a": LOOP}), "expected a number or a word"),
    (lambda: pc.Study(fix={"friction": LOOP}), "expected a number or a word"),
    (lambda: pc.coverage({"a": LOOP}, pc.Space({"a": [1, 2]})), "expected a number or a word"),
    (lambda: pc.Space({"a": [np.True_, 2]}), "expected a number or a word"),
    (lambda: pc.Generator(2, "halton").ask(2**62), "do not fit in memory"),
    (lambda: pc.Generator(2, "bayes").tell([[0.5, 0.5]], [False]), "found a truth as a robustness"),
    (lambda: pc.coverage(pc.sample(SPACE, 3), pc.Space({"speed": (0.5, 10), "lanes": [2, 4, 6]}, ["lanes > 2"])), "belong to another space"),
    (lambda: pc.Space.read("/no/such/file.toml"), "cannot read /no/such/file.toml"),
    (lambda: pc.covering_array(pc.Space({"a": (0, 1)}), k=1), "k is 1"),
    (lambda: pc.covering_array(pc.Space({"a": [1, 2]}), k=2), "k is 2"),
    (lambda: pc.plan(SPACE, epsilon=2), "epsilon is 2"),
    (lambda: pc.Formula("always (x <"), "column 12: found the end"),
    (lambda: pc.Formula("always (x < 3)").evaluate({"time": [0, 1], "y": [1, 2]}), "found `x`, expected a signal"),
    (lambda: pc.Trace({"time": [0, 1, 3], "y": [1, 2, 3]}), "not evenly spaced"),
    (lambda: pc.Trace({"t": [0, 1], "y": [1, 2]}), "expected `time` among them"),
    (lambda: pc.Trace({"time": [0, 1], "y": [1, NAN]}), "`y` has no finite value"),
    (lambda: pc.Trace({"time": [0, 1], "y": [[1], [2]]}), "signal `y` has the shape (2, 1)"),
]


@pytest.mark.parametrize(("call", "words"), WRONG, ids=[words for _, words in WRONG])
def test_bad_input_is_an_exception_that_says_what_was_expected(call, words):
    with pytest.raises(pc.Error) as caught:
        call()
    assert words in str(caught.value)
    assert isinstance(caught.value, ValueError)


def test_what_is_no_whole_number_is_an_error_of_python():
    for found in (2.5, True, "two"):
        with pytest.raises(TypeError, match=f"found {found!r}, expected a whole number"):
            pc.sample(3, found)


def test_a_name_that_does_not_exist_is_an_error_of_python():
    with pytest.raises(AttributeError, match="nope"):
        pc.nope
    with pytest.raises(KeyError, match="did you mean `speed`"):
        pc.sample(SPACE, 3)["sped"]
    with pytest.raises(IndexError, match="row 3 of a table with 3 rows"):
        pc.sample(SPACE, 3)[3]
    with pytest.raises(TypeError):
        pc.sample(2, 5, sede=1)


def test_a_note_on_a_file_is_a_warning(tmp_path):
    model = tmp_path / "model.pict"
    model.write_text('A: 1, 2\nB: 1, 2\nIF [C] = 1 THEN [A] = 1;\n')
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        pc.Space.read(model)
    assert any("model.pict" in str(warning.message) for warning in caught)
