"""The notebooks of `examples/notebooks` run, and show what they promise."""

from pathlib import Path
from typing import Any

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")

NOTEBOOKS = Path(__file__).parents[2] / "examples" / "notebooks"


def ran(name: str, folder: Path) -> tuple[str, list[str]]:
    """Runs a notebook, and returns its printed text and the kinds of its results."""
    notebook = nbformat.read(NOTEBOOKS / f"{name}.ipynb", 4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "a notebook in the repository has no outputs"
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(folder)}}).execute()
    outputs: list[Any] = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    text = "".join(output.get("text", "") for output in outputs)
    return text, [kind for output in outputs for kind in output.get("data", {})]


def test_samplers_are_compared_for_a_paper(tmp_path):
    pytest.importorskip("scipy")
    pytest.importorskip("pandas")
    text, kinds = ran("compare_samplers", tmp_path)
    assert "jittered" in text and r"\begin{table}" in text and "image/png" in kinds and "text/html" in kinds
    assert (tmp_path / "compared" / "table.tex").exists()


def test_a_model_is_falsified(tmp_path):
    pytest.importorskip("cma")
    text, kinds = ran("falsify_a_model", tmp_path)
    found = {line.split()[0]: float(line.split()[2].rstrip(",")) for line in text.splitlines() if " median " in line}
    assert found["auto"] < found["random"] and "(rpm < 5000)" in text and "text/html" in kinds


def test_a_scenario_is_written_and_a_driver_fails(tmp_path):
    text, kinds = ran("find_where_a_driver_fails", tmp_path)
    assert "already when" in text and "mended" in text and "image/png" in kinds
    assert (tmp_path / "crossing" / "failure-map.png").exists()
