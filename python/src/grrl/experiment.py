"""Policies compared over many experiments, your own among them: python -m grrl.experiment.

The experiments, their seeds and the columns of trials.csv are those of grrl-experiment, so that a
policy of Python is paired with ours by seed.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import csv
import importlib
import importlib.util
import io
import math
import multiprocessing
import os
import pathlib
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from . import _native
from .learner import Learner
from .world import Supervisor, TrialResult, run_trial

COLUMNS = ("object", "policy", "pretrain", "experiment", "seed", "trial", "pushes", "outcome",
           "wrong_joints")
_PRETRAIN_SEED = 10**15
_EPILOG = """\
NAME is one of the library's ({policies}),
or FILE.py:CLASS or MODULE:CLASS of a policy of your own; see docs/python.md. OUT then holds trials.csv.
Exit status: 0 fine; 1 trouble; 2 wrong command line."""


@dataclass(frozen=True)
class Curve:
    """A policy on an object, with or without trials of another object before."""

    object: str
    policy: str
    pretrain: str = ""
    pretrain_trials: int = 0

    @property
    def pretrain_text(self) -> str:
        return f"{self.pretrain}:{self.pretrain_trials}" if self.pretrain else "none"


@dataclass(frozen=True)
class Plan:
    """What all experiments share."""

    trials: int = 50
    seed: int = 1
    cap: int = 100
    noise: float = 0.0007


def experiment_seed(seed: int, experiment: int) -> int:
    return 1000 * seed + experiment


def load_policy(name: str) -> Any:
    """The name of a policy of the library as it is, else a new object of the class that is named.

    Raises
    ------
    ValueError
        There is no such policy, file, module or class.
    """
    if name in _native.POLICIES:
        return name
    where, colon, kind = name.rpartition(":")
    if not colon or not kind.isidentifier():
        raise ValueError(f"policy {name}: must be one of {', '.join(_native.POLICIES)}, or "
                         "FILE.py:CLASS or MODULE:CLASS")
    try:
        found = getattr(_module(where), kind)
    except (ImportError, OSError, AttributeError, SyntaxError) as error:
        raise ValueError(f"policy {name}: {error}") from None
    return found()


def _module(where: str) -> Any:
    if not where.endswith(".py"):
        return importlib.import_module(where)
    spec = importlib.util.spec_from_file_location(pathlib.Path(where).stem, where)
    if spec is None or spec.loader is None:
        raise ImportError(f"{where} is no Python file")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def policy_name(name: str) -> str:
    """As trials.csv has it: the class's attribute `name`, or the class."""
    policy = load_policy(name)
    return policy if isinstance(policy, str) else str(getattr(policy, "name", type(policy).__name__))


def _learner(curve: Curve, plan: Plan, seed: int) -> Learner:
    return Learner(load_policy(curve.policy), seed=seed, noise=plan.noise)


def run_experiment(curve: Curve, plan: Plan, experiment: int) -> list[TrialResult]:
    """One experiment, from no experience.

    Parameters
    ----------
    curve : Curve
    plan : Plan
    experiment : int
        From 1; its seed is 1000 times the plan's plus this.
    """
    seed = experiment_seed(plan.seed, experiment)
    learner = _learner(curve, plan, seed)
    if curve.pretrain:
        before = _learner(curve, plan, seed + _PRETRAIN_SEED)
        for trial in range(1, curve.pretrain_trials + 1):
            run_trial(before, curve.pretrain, trial, cap=plan.cap, noise=plan.noise)
        learner.from_bytes(before.to_bytes())
    return [run_trial(learner, curve.object, trial, cap=plan.cap, noise=plan.noise)
            for trial in range(1, plan.trials + 1)]


def trials_csv(plan: Plan, results: list[tuple[Curve, list[list[TrialResult]]]]) -> str:
    """The text of trials.csv: for each curve the trials of each of its experiments."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(COLUMNS)
    for curve, experiments in results:
        name = policy_name(curve.policy)
        for number, trials in enumerate(experiments, 1):
            for row in trials:
                rows.writerow((curve.object, name, curve.pretrain_text, number,
                               experiment_seed(plan.seed, number), row.trial, row.pushes,
                               "discovered" if row.discovered else "capped", row.wrong_joints))
    return text.getvalue()


def _mean(values: list[float]) -> str:
    """Mean and half of the 95% interval, by the normal distribution."""
    n = len(values)
    mean = sum(values) / n
    if n < 2:
        return f"{mean:.1f}"
    sd = math.sqrt(sum((v - mean) ** 2 for v in values) / (n - 1))
    return f"{mean:.1f} +- {1.96 * sd / math.sqrt(n):.1f}"


def table(results: list[tuple[Curve, list[list[TrialResult]]]]) -> Iterator[str]:
    """Means of pushes over experiments, a line for each curve."""
    for curve, experiments in results:
        trials = len(experiments[0])
        parts = {"trial 1": (0, 1), f"1-{min(5, trials)}": (0, min(5, trials)), "all": (0, trials)}
        cells = [f"{label} {_mean([sum(t.pushes for t in e[a:b]) / (b - a) for e in experiments])}"
                 for label, (a, b) in parts.items()]
        after = f" after {curve.pretrain_text}" if curve.pretrain else ""
        yield f"{curve.object} {policy_name(curve.policy)}{after}: pushes " + ", ".join(cells)


# --- the command line -----------------------------------------------------------------------------


def _whole(low: int, high: int) -> Any:
    def parse(text: str) -> int:
        if not text.isdigit() or not low <= int(text) <= high:
            raise argparse.ArgumentTypeError(f"{text}: must be a whole number from {low} to {high}")
        return int(text)

    return parse


def _millimetres(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 <= value <= 100.0:
        raise argparse.ArgumentTypeError(f"{text}: must be a number from 0 to 100")
    return value


def _pretrain(text: str) -> tuple[str, int]:
    name, colon, number = text.rpartition(":")
    if not colon or not name or not number.isdigit() or not 1 <= int(number) <= 10000:
        raise argparse.ArgumentTypeError(f"{text}: must be OBJECT:N, such as PRPRP:50")
    return name, int(number)


def _parse(arguments: list[str] | None) -> tuple[argparse.ArgumentParser, argparse.Namespace]:
    parser = argparse.ArgumentParser(
        prog="python -m grrl.experiment", allow_abbrev=False, description=__doc__,
        epilog=_EPILOG.format(policies=", ".join(_native.POLICIES)),
        formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--object", required=True, help="chain (RPR), term (D(lb, R(l1, l2))) or file")
    add("--policy", default="learn", metavar="NAME[,..]", help="who chooses, see below (learn)")
    add("--pretrain", type=_pretrain, metavar="OBJECT:N", help="compare with N trials of another before")
    add("--trials", type=_whole(1, 10000), default=50, metavar="N", help="of an experiment (50)")
    add("--experiments", type=_whole(1, 1000), default=20, metavar="N", help="without experience (20)")
    add("--seed", type=_whole(0, 10**9), default=1, metavar="N",
        help="experiment i has the seed 1000 N + i (1)")
    add("--jobs", type=_whole(1, 256), default=os.cpu_count() or 1, metavar="N",
        help="experiments at the same time (one for each core)")
    add("--cap", type=_whole(1, 100000), default=100, metavar="N", help="pushes in a trial (100)")
    add("--noise", type=_millimetres, default=0.7, metavar="MM",
        help="standard deviation of a tracked point (0.7)")
    add("--out", required=True, type=pathlib.Path, metavar="DIR", help="folder for the results")
    return parser, parser.parse_args(arguments)


def _curves(options: argparse.Namespace) -> list[Curve]:
    Supervisor(options.object)  # raises ValueError
    if options.pretrain:
        Supervisor(options.pretrain[0])
    curves = []
    for name in options.policy.split(","):
        learns = Learner(load_policy(name)).learns  # raises ValueError, too
        curves.append(Curve(options.object, name))
        if options.pretrain and learns:
            curves.append(Curve(options.object, name, *options.pretrain))
    return curves


def run(curves: list[Curve], plan: Plan, experiments: int,
        jobs: int = 1) -> list[tuple[Curve, list[list[TrialResult]]]]:
    """All experiments of all curves.

    Parameters
    ----------
    curves : list of Curve
    plan : Plan
    experiments : int
        Of each curve.
    jobs : int
        Processes at the same time; 1: this one.
    """
    tasks = [(curve, plan, number) for curve in curves for number in range(1, experiments + 1)]
    if jobs == 1:
        done = [run_experiment(*task) for task in tasks]
    else:
        with concurrent.futures.ProcessPoolExecutor(
                min(jobs, len(tasks)), multiprocessing.get_context("spawn")) as pool:
            done = list(pool.map(run_experiment, *zip(*tasks)))
    return [(curve, done[i * experiments:(i + 1) * experiments]) for i, curve in enumerate(curves)]


def main(arguments: list[str] | None = None) -> int:
    parser, options = _parse(arguments)
    plan = Plan(options.trials, options.seed, options.cap, options.noise * 0.001)
    try:
        curves = _curves(options)
    except ValueError as error:
        parser.error(str(error))
    try:
        options.out.mkdir(parents=True, exist_ok=True)
        results = run(curves, plan, options.experiments, options.jobs)
        path = options.out / "trials.csv"
        path.with_suffix(".new").write_text(trials_csv(plan, results), encoding="utf-8")
        path.with_suffix(".new").replace(path)
    except (OSError, RuntimeError, TypeError, ValueError) as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return 1
    for line in table(results):
        print(line)
    print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
