"""SALib as a judge of Sobol indices: `sample` prints points of the unit cube, `analyze` the indices of values at them."""

import json
import sys

import numpy as np
from SALib.analyze import sobol as analyze
from SALib.sample import sobol as sample


def problem(parameters):
    # An array, because pandas 3 takes no list where SALib hands it the names.
    names = np.array([f"x{index}" for index in range(parameters)])
    return {"num_vars": parameters, "names": names, "bounds": [[0.0, 1.0]] * parameters}


def points(case):
    return sample.sample(problem(case["parameters"]), case["pairs"], calc_second_order=False, seed=11).tolist()


def indices(case):
    found = analyze.analyze(
        problem(case["parameters"]), np.array(case["values"]), calc_second_order=False, num_resamples=1000, seed=11
    )
    return {name: np.asarray(found[name]).tolist() for name in ["S1", "S1_conf", "ST", "ST_conf"]}


cases = json.load(sys.stdin)
json.dump([{"sample": points, "analyze": indices}[sys.argv[1]](case) for case in cases], sys.stdout)
