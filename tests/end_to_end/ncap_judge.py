"""The rating calculator of Euro NCAP as a judge of points: reads the impact speeds of a grid, prints the points of its standard range."""

import importlib.resources
import json
import sys

import openpyxl
from euroncap_rating_2026.common import PredictionColor
from euroncap_rating_2026.crash_avoidance import data_model, matrix_processing, test_info

SHEETS = ["FC - Car & PTW pred.", "FC - Ped & Cyc pred."]


def standard_range(book, grid):
    """The tests of the standard range in the template of the calculator, as its own test points with their places."""
    for sheet in (book[name] for name in SHEETS):
        rows = list(sheet.iter_rows(values_only=True))
        heads = [index for index, row in enumerate(rows) if row[0] == grid]
        if not heads:
            continue
        head, columns = heads[0], data_model.MATRIX_INDICES[grid]
        places = range(columns["start_col"], columns["start_col"] + columns["n_cols"])
        found = []
        for row, cells in enumerate(rows[head + 2 :]):
            if not (cells[0] or "").endswith("km/h"):
                break
            for column, place in enumerate(places):
                if matrix_processing.check_extended_range(row, column, grid) == matrix_processing.TestRange.STANDARD:
                    found.append((row, column, cells[0], rows[head + 1][place]))
        return found
    raise KeyError(grid)


def points(book, grid, impacts):
    scored = []
    for row, column, speed, location in standard_range(book, grid):
        point = matrix_processing.TestPoint(
            row, column, PredictionColor.GREEN, matrix_processing.TestRange.STANDARD, {"VUT speed": speed}
        )
        impact = impacts[f"{speed.removesuffix(' km/h')} at {100 * location:g}"]
        # The colour of the band, without the tolerance for a prediction, since nobody has predicted anything.
        point.color = matrix_processing.ComputedTestPoint(point, grid, impact).measured_color
        scored.append(point)
    return len(scored), test_info.compute_predicted_score(grid, scored)[0]


with importlib.resources.files("data").joinpath("ca_template.xlsx").open("rb") as template:
    workbook = openpyxl.load_workbook(template)
json.dump([points(workbook, case["grid"], case["impacts"]) for case in json.load(sys.stdin)], sys.stdout)
