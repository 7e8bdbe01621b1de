"""First trials of robots that start from a store.

    python python/bench/first_object.py examples/mixed.store PPRRP RPRPRPR "R(l1, l2, l3, l4)"

Each object gets --robots robots of the policy learn, with seeds from --seed on, and --trials trials
each. Prints the mean pushes of the first trial and of all of them, with 95% intervals of the mean over
robots.
"""

from __future__ import annotations

import argparse
import statistics

import grrl

T_95 = {10: 2.262, 20: 2.093, 40: 2.023}
"""Student's t for 95%, two-sided, by the number of robots."""


def interval(values: list[float]) -> str:
    """The mean and half of its 95% interval."""
    half = T_95[len(values)] * statistics.stdev(values) / len(values) ** 0.5
    return f"{statistics.mean(values):.1f} +- {half:.1f}"


def lives(store: str, name: str, seeds: range, trials: int) -> list[list[int]]:
    """Pushes of each robot in each trial."""
    pushes = []
    for seed in seeds:
        learner = grrl.Learner("learn", seed=seed)
        learner.load(store)
        pushes.append([grrl.run_trial(learner, name, trial, seed=seed).pushes
                       for trial in range(1, trials + 1)])
    return pushes


def main() -> None:
    """Reads the command line and prints a line for each object."""
    parser = argparse.ArgumentParser(description="First trials of robots that start from a store.")
    parser.add_argument("store", help="a file of grrl-agent --store, or examples/mixed.store")
    parser.add_argument("object", nargs="+", help="a chain such as RPRPRPR, or a term")
    parser.add_argument("--robots", type=int, default=20, choices=sorted(T_95))
    parser.add_argument("--trials", type=int, default=5)
    parser.add_argument("--seed", type=int, default=71)
    options = parser.parse_args()
    seeds = range(options.seed, options.seed + options.robots)
    for name in options.object:
        pushes = lives(options.store, name, seeds, options.trials)
        first = interval([life[0] for life in pushes])
        mean = interval([statistics.mean(life) for life in pushes])
        print(f"{name}: first trial {first}, first {options.trials} {mean}")


if __name__ == "__main__":
    main()
