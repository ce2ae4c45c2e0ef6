"""Comparisons of strategies, with samplers of other packages beside ours."""

import csv
from typing import Any

import numpy as np
import paracosm as pc
import pytest
from paracosm import qmc

SMALL: dict[str, Any] = {"dims": [2], "budgets": [16, 32], "seeds": 5, "measures": ["dispersion", "l2-star"]}


def test_a_comparison_has_the_files_and_numbers_of_the_program(cover, tmp_path):
    compared = pc.compare(["halton", "random", "lhs"], **SMALL)
    compared.write(tmp_path / "ours")
    options = ["--dims", "2", "--budgets", "16,32", "--seeds", "5", "--measures", "dispersion,l2-star"]
    cover("compare", "--strategies", "halton,random,lhs", *options, "--out", str(tmp_path / "theirs"))
    files = sorted(path.name for path in (tmp_path / "theirs").iterdir())
    assert sorted(path.name for path in (tmp_path / "ours").iterdir()) == files and "table.tex" in files
    for file in files:
        assert (tmp_path / "ours" / file).read_bytes() == (tmp_path / "theirs" / file).read_bytes(), file
    with open(tmp_path / "ours" / "summary.csv") as file:
        rows = list(csv.DictReader(file))
    assert [row["strategy"] for row in rows] == list(compared.summary["strategy"])
    assert [float(row["median"]) for row in rows] == list(compared.summary["median"])
    assert "dispersion" in str(compared) and repr(compared) == f"Comparison(halton, random, lhs: {len(compared.sets)} sets)"


@pytest.mark.parametrize("strategy", [qmc.SobolOwen, lambda d, rng: qmc.SobolOwen(d, rng=rng), lambda d, seed: pc.Generator(d, "sobol-owen", seed=seed)])
def test_a_sampler_of_a_user_stands_beside_ours(strategy):
    frame = pc.compare({"halton": "halton", "sobol-owen": "sobol-owen", "mine": strategy}, **SMALL).summary.to_pandas()
    ours, mine = frame[frame["strategy"] == "sobol-owen"], frame[frame["strategy"] == "mine"]
    assert len(ours) == 4
    for column in ("median", "lower_quartile", "ratio", "wilcoxon_p", "holm_p"):
        assert (ours[column].to_numpy() == mine[column].to_numpy()).all(), column


def test_samplers_of_scipy_and_optuna_have_rows_and_curves(tmp_path):
    scipy_qmc = pytest.importorskip("scipy.stats.qmc")
    optuna = pytest.importorskip("optuna")
    compared = pc.compare(["halton", scipy_qmc.LatinHypercube, optuna.samplers.QMCSampler(seed=1)], **SMALL)
    assert set(compared.summary["strategy"]) == {"halton", "LatinHypercube", "QMCSampler"}
    compared.write(tmp_path / "out")
    assert "LatinHypercube" in (tmp_path / "out" / "table.tex").read_text()
    assert "QMCSampler" in (tmp_path / "out" / "dispersion-d2.svg").read_text()


def test_progress_is_told():
    told: list[tuple[int, int]] = []
    pc.compare(["random", "lhs"], **SMALL, executor=1, progress=lambda done, sets: told.append((done, sets)))
    assert told[-1] == (20, 20)


class Short:
    def ask(self, n: int) -> np.ndarray:
        return np.zeros((n - 1, 2))

    def tell(self, X: np.ndarray, y: np.ndarray) -> None:
        pass


@pytest.mark.parametrize(
    ("strategies", "choices", "message"),
    [
        (["haltn"], {}, "did you mean `halton`"),
        (["bayes"], {}, "`bayes` learns from the results of tests"),
        ([], {}, "no strategy is named"),
        ("halton", {}, r"expected a list, such as \['halton'\]"),
        ([Short()], {}, "the strategy `Short` made 15 points in 2 dimensions, expected 16"),
        ([qmc.Halton(3)], {}, r"the strategy `Halton`, 16 points in 2 dimensions: ask\(16\) returned an array of the shape \(16, 3\)"),
        ([qmc.Halton], {"seed": 3}, "seed is 3, expected 1"),
        ({"lhs": qmc.Halton}, {}, "called `lhs` already"),
        ({"a b": qmc.Halton}, {}, "expected letters, digits"),
        ({"a": "halton"}, {}, "which keeps its name"),
        ([qmc.Halton, qmc.Halton], {}, "twice"),
        (["halton"], {"baseline": "lhs"}, "the baseline lhs is not among the strategies"),
        (["halton"], {"dims": [0]}, "found 0 among the dimensions"),
        (["halton"], {"measures": ["dispersio"]}, "did you mean `dispersion`"),
    ],
)
def test_a_comparison_that_cannot_be_is_an_error(strategies, choices, message):
    with pytest.raises(pc.Error, match=message):
        pc.compare(strategies, **{**SMALL, **choices})
