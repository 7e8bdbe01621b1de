"""python/bench/deep_rl.py: the policies of the library, and MaskablePPO where it is installed."""

import csv
import importlib.util
import subprocess
import sys

import pytest
from conftest import ROOT, run

SCRIPT = ROOT / "python" / "bench" / "deep_rl.py"


def bench(*arguments, timeout=300):
    return subprocess.run([sys.executable, str(SCRIPT), *map(str, arguments)], capture_output=True,
                          text=True, check=False, timeout=timeout)


def rows_of(folder):
    with open(folder / "trials.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_ours_are_those_of_the_program(tmp_path):
    done = bench("--out", tmp_path / "bench", "--object", "RPR", "--methods", "random,rule,paper,learn",
                 "--runs", 2, "--trials", 3)
    assert done.returncode == 0, done.stderr
    assert "learn: 2 runs of " in done.stdout
    assert (tmp_path / "bench" / "deep_rl.svg").stat().st_size > 5000
    run("EXPERIMENT", "--object", "RPR", "--policy", "random,rule,paper,learn", "--experiments", 2,
        "--trials", 3, "--out", tmp_path / "c")
    ours, theirs = rows_of(tmp_path / "bench"), rows_of(tmp_path / "c")
    assert [(row["method"], row["run"], row["pushes"]) for row in ours] == [
        (row["policy"], row["experiment"], row["pushes"]) for row in theirs]
    used = 0
    for row in ours[:3]:
        assert int(row["pushes_used"]) == used
        used += int(row["pushes"])


def test_wrong_command_lines(tmp_path):
    done = bench("--out", tmp_path, "--methods", "best")
    assert done.returncode == 2 and "must be one of random" in done.stderr
    if importlib.util.find_spec("sb3_contrib") is None:
        done = bench("--out", tmp_path)
        assert done.returncode == 2 and "pip install './python[bench]'" in done.stderr


def test_deep(tmp_path):
    pytest.importorskip("sb3_contrib")
    done = bench("--out", tmp_path, "--object", "RR", "--methods", "ppo", "--ppo-runs", 1, "--pushes",
                 1024, timeout=600)
    assert done.returncode == 0, done.stderr
    assert "50 fresh trials, best action" in done.stdout
    rows = rows_of(tmp_path)
    assert sum(int(row["pushes"]) for row in rows) <= 1024
    assert all(int(row["pushes_used"]) >= 0 for row in rows)
