"""The Python of docs/python.md and of the README runs as printed."""

import os
import re
import subprocess
import sys

import pytest
from conftest import ROOT


@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_snippets(page, tmp_path):
    text = (ROOT / page).read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    assert blocks
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    (tmp_path / "out").mkdir()
    done = subprocess.run([sys.executable, "-W", "error", "-c", "\n".join(blocks)], cwd=tmp_path,
                          capture_output=True, text=True, check=False, timeout=300,
                          env={**os.environ, "MPLBACKEND": "Agg"})
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[0] == "D(lb, R(L(s, f1), L(s, f2)))"
    if page == "docs/python.md":
        assert (tmp_path / "out" / "hinge.png").stat().st_size > 10000
        assert (tmp_path / "out" / "learned.store").exists()


def test_the_command_of_the_page(tmp_path):
    text = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    command, = re.findall(r"^    python -m (grrl\.experiment .*)$", text, re.MULTILINE)
    words = command.replace("--out out", f"--out {tmp_path}").split()
    done = subprocess.run([sys.executable, "-m", *words, "--experiments", "1", "--trials", "1", "--jobs",
                           "1"], cwd=ROOT, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr
    assert "longest-first" in (tmp_path / "trials.csv").read_text(encoding="utf-8")
