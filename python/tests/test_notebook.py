"""examples/tour.ipynb runs as printed, and the README shows its picture."""

import warnings

import matplotlib.image
import nbformat
import numpy as np
import pytest
from conftest import ROOT
from nbclient import NotebookClient

import grrl

NOTEBOOK = ROOT / "examples" / "tour.ipynb"
PICTURE = "film-to-joints.jpg"


def texts_of(notebook):
    """What each of its cells prints: a busy machine sends one text in several pieces."""
    return ["".join(output["text"] for output in cell.outputs
                    if output.output_type == "stream")
            for cell in notebook.cells if cell.cell_type == "code"]


@pytest.mark.skipif(not grrl.HAS_WORLD, reason="needs the simulated world")
def test_notebook(tmp_path):
    for name in ("arm.mp4", "arm.csv"):
        (tmp_path / name).symlink_to(ROOT / "examples" / name)
    (tmp_path / "out").mkdir()
    printed = nbformat.read(NOTEBOOK, as_version=4)
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of Jupyter, about its sockets
        NotebookClient(notebook, timeout=900, kernel_name="python3",
                       resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert texts_of(notebook) == texts_of(printed)
    assert "D(lb, R(R(L(s, f2), P(L(l, f1), L(s, f4))), L(s, f3)))" in texts_of(notebook)[1]
    drawn, shown = (matplotlib.image.imread(path).astype(float)
                    for path in (tmp_path / "out" / PICTURE, ROOT / "docs" / "images" / PICTURE))
    assert drawn.shape == shown.shape and np.abs(drawn - shown).mean() < 3.0  # of 255
    assert f"docs/images/{PICTURE}" in (ROOT / "README.md").read_text(encoding="utf-8")
