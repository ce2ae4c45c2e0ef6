"""Formulas judge traces of arrays."""

import math

import numpy as np
import paracosm as pc
import pytest

TIME = np.arange(0, 2.01, 0.5)
RPM = [1000, 3000, 4800, 4000, 2000]


def test_a_formula_is_evaluated_on_a_dictionary_of_columns():
    found = pc.Formula("always[0,1] (rpm < 4750)").evaluate({"time": TIME, "rpm": RPM})
    assert (found.truth, found.robustness, found.lower, found.upper) == (False, -50.0, -50.0, -50.0)
    assert found.cause == (1.0, "(rpm < 4750)")


def test_a_trace_that_was_cut_short_leaves_a_formula_undecided():
    trace = pc.Trace({"time": TIME, "rpm": RPM}, complete=False)
    formula = pc.Formula("eventually (rpm > 5000)")
    assert formula.evaluate(trace).truth is None
    assert formula.evaluate(pc.Trace({"time": TIME, "rpm": RPM})).truth is False


def test_dense_time_looks_between_samples():
    formula, trace = pc.Formula("always (x < 0.5 or y < 0.5)"), {"time": [0, 1], "x": [1, 0], "y": [0, 1]}
    assert formula.robustness(trace) == 0.5
    assert formula.robustness(trace, dense=True) == pytest.approx(0.0)


def test_a_trace_gives_its_columns_back():
    trace = pc.Trace({"time": TIME, "rpm": RPM, "gear": [1, 2, 3, 3, 2]})
    assert trace.signals == ["rpm", "gear"] and trace.columns == ["time", "rpm", "gear"]
    assert np.array_equal(trace["time"], TIME) and trace.dt == 0.5 and len(trace) == 5
    assert {name: column.tolist() for name, column in trace.to_dict().items()}["rpm"] == RPM
    assert trace.hash == pc.Trace(trace.to_dict()).hash


def test_a_truth_has_no_distance():
    assert pc.Formula("always safe").robustness({"time": [0, 1], "safe": [True, True]}) == math.inf
