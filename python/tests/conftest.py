"""What the tests share: files of the tree, the C programs, a moving hinge."""

import os
import pathlib
import subprocess

import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture
def hinge_csv():
    return ROOT / "examples" / "hinge.csv"


def program(name):
    """A program of the C build, or a skip."""
    path = os.environ.get(f"GRRL_{name}")
    if not path:
        pytest.skip(f"needs the environment variable GRRL_{name}: ctest -R '^python$' sets it")
    return path


def run(name, *arguments, status=0):
    done = subprocess.run([program(name), *map(str, arguments)], capture_output=True, text=True,
                          timeout=300, check=False)
    assert done.returncode == status, done.stderr
    return done.stdout


def hinge(frames=40, points=10, noise=0.3, seed=1, turn=0.8):
    """(frames, 2 * points, 2): two bodies of 120 x 20 about a pivot at (40, -20), the second turns."""
    random = np.random.default_rng(seed)
    a = random.uniform((-80, -30), (35, -10), (points, 2))
    b = random.uniform((45, -30), (160, -10), (points, 2)) - (40, -20)
    scene = np.empty((frames, 2 * points, 2))
    for f, angle in enumerate(np.linspace(0, turn, frames)):
        c, s = np.cos(angle), np.sin(angle)
        scene[f] = np.r_[a, b @ np.array([[c, s], [-s, c]]) + (40, -20)]
    return scene + random.normal(0, noise, scene.shape)


def write_csv(path, array, names="frame,point,x,y", digits=3):
    """Rows of an array; NaN: none."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(names + "\n")
        for f, frame in enumerate(array):
            for p, (x, y) in enumerate(frame):
                if not np.isnan(x):
                    file.write(f"{f},{p},{x:.{digits}f},{y:.{digits}f}\n")
