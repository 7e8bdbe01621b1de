"""The package as it is installed: typed, of the project's version, without leaks."""

import ast
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT

import grrl

HERE = pathlib.Path(grrl.__file__).parent

EVERYTHING = """
import numpy as np, grrl
class Mine:
    def choose(self, view, random):
        return 0, random.below(6)
grrl.run_trial(grrl.Learner(Mine()), "RR", cap=3)
grrl.run_trial(grrl.Learner("learn"), "RR", cap=3)
grrl.perceive(np.random.default_rng(1).normal(0, 50, (20, 30, 2)), "mm")
learner = grrl.Learner("paper")
world, supervisor = grrl.World("RR"), grrl.Supervisor("RR")
supervisor.judge(learner), supervisor.poses(world), world.observe().points
for wrong in (lambda: grrl.World("X"), lambda: learner.choose(), lambda: learner.from_bytes(b"x")):
    try:
        wrong()
    except (ValueError, RuntimeError):
        pass
"""


def test_version_is_the_projects():
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    version = re.search(r"project\(grrl VERSION ([0-9.]+)", text).group(1)
    assert grrl.__version__ == version


def test_types_are_installed():
    assert (HERE / "py.typed").exists()
    stub = (HERE / "_native.pyi").read_text(encoding="utf-8")
    assert "class Learner" in stub and "def perceive(" in stub


def test_everything_public_is_documented_and_typed():
    for path in HERE.glob("*.py"):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        assert ast.get_docstring(tree), path
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                assert node.returns is not None, f"{path}:{node.lineno}"
                given = [a for a in node.args.args + node.args.kwonlyargs
                         if a.arg not in ("self", "cls")]
                assert all(a.annotation for a in given), f"{path}:{node.lineno}"
    for name in grrl.__all__:
        thing = getattr(grrl, name)
        if isinstance(thing, type) or callable(thing):
            assert thing.__doc__, name


def test_nothing_is_left_at_exit():
    done = subprocess.run([sys.executable, "-c", EVERYTHING], capture_output=True, text=True,
                          check=False, env={**os.environ, "GRRL_LEAK_WARNINGS": "1"})
    assert (done.returncode, done.stderr) == (0, "")


def test_messages_are_beside_it():
    """Of the name that the C build gives them; lcm-gen's own name would hide this package."""
    if not shutil.which("lcm-gen"):
        pytest.skip("needs lcm-gen when the package is built")
    import grrl_lcmtypes

    points = grrl_lcmtypes.points_t()
    points.seq, points.n_points, points.id, points.x, points.y = 7, 1, [3], [0.5], [0.25]
    again = grrl_lcmtypes.points_t.decode(points.encode())
    assert (again.seq, list(again.id), list(again.x)) == (7, [3], [0.5])
    assert pathlib.Path(grrl_lcmtypes.__file__).parent.parent == HERE.parent
