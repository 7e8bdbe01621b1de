"""Pushes to discover against pushes used: the library's policies, a rule, and deep reinforcement learning.

    pip install './python[bench]'
    python python/bench/deep_rl.py --out out

The deep one is MaskablePPO of sb3-contrib on grrl/Discover-v0. Everyone learns as they go, and every
trial shows another pose of the object; seeds are those of grrl-experiment. docs/benchmark-rl.md has
what came out.
"""

import argparse
import concurrent.futures
import csv
import importlib.util
import math
import multiprocessing
import pathlib
import sys

import numpy as np

import grrl
from grrl import experiment

RULE = str(pathlib.Path(__file__).parents[1] / "examples" / "longest_first.py") + ":LongestFirst"
OURS = {"random": "random", "rule": RULE, "paper": "paper", "learn": "learn"}
PPO = "ppo"
COLOURS = {"random": "#888888", "rule": "#009e73", "paper": "#d55e00", "learn": "#0072b2", PPO: "#cc79a7"}
ENVIRONMENTS = 8  # that MaskablePPO pushes in at the same time
CAP = 100  # pushes in a trial
FRESH_TRIALS = 50  # after training
FRESH_SEED = 10**6  # away from those of training
# 97.5% quantiles of Student's t by degrees of freedom, from 1 on.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160,
           2.145, 2.131, 2.120, 2.110, 2.101, 2.093)


def interval(values):
    """Mean, and half of the 95% interval."""
    n = len(values)
    if n < 2:
        return float(np.mean(values)), math.nan
    t = STUDENT[n - 2] if n - 2 < len(STUDENT) else 1.96
    return float(np.mean(values)), float(t * np.std(values, ddof=1) / math.sqrt(n))


# --- one run: a list of (pushes used before, pushes of the trial, discovered) ----------------------


def run_ours(policy, name, seed, trials):
    """trials of one experiment without experience."""
    learner = grrl.Learner(experiment.load_policy(policy), seed=seed)
    rows, used = [], 0
    for trial in range(1, trials + 1):
        result = grrl.run_trial(learner, name, trial, cap=CAP)
        rows.append((used, result.pushes, result.discovered))
        used += result.pushes
    return rows, {}


def make_environments(name, seed):
    import gymnasium
    from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

    envs = DummyVecEnv([lambda: gymnasium.make("grrl/Discover-v0", object=name, cap=CAP).unwrapped
                        for _ in range(ENVIRONMENTS)])
    envs.seed(seed * ENVIRONMENTS)  # each its own
    return VecNormalize(envs, norm_reward=False, norm_obs_keys=["links", "joints", "tried"])


def run_ppo(name, seed, pushes, settings):
    """The trials of training, and those of the trained policy, by its best action and by its draws."""
    import torch
    from sb3_contrib import MaskablePPO
    from stable_baselines3.common.callbacks import BaseCallback

    class Trials(BaseCallback):
        def __init__(self):
            super().__init__()
            self.rows = []

        def _on_step(self):
            for done, info in zip(self.locals["dones"], self.locals["infos"]):
                if done:
                    found = not info.get("TimeLimit.truncated", False)
                    before = self.num_timesteps - ENVIRONMENTS * info["pushes"]
                    self.rows.append((before, info["pushes"], found))
            return True

    torch.set_num_threads(1)
    trials = Trials()
    model = MaskablePPO("MultiInputPolicy", make_environments(name, seed), seed=seed, device="cpu",
                        **settings)
    model.learn(pushes, callback=trials)
    fresh = {"best action": try_out(model, name, seed, True), "sampled": try_out(model, name, seed, False)}
    return trials.rows, fresh


def try_out(model, name, seed, deterministic):
    """Pushes of fresh trials."""
    import gymnasium

    env = gymnasium.make("grrl/Discover-v0", object=name, cap=CAP).unwrapped
    normalise = model.get_vec_normalize_env().normalize_obs
    counts = []
    for trial in range(1, FRESH_TRIALS + 1):
        observation, info = env.reset(seed=FRESH_SEED + seed, options={"trial": trial})
        over = False
        while not over:
            action, _ = model.predict(normalise(observation), action_masks=env.action_masks(),
                                      deterministic=deterministic)
            observation, _, found, capped, info = env.step(int(action))
            over = found or capped
        counts.append(info["pushes"])
    return counts


def one_run(method, seed, options):
    if method == PPO:
        settings = {"n_steps": 128, "batch_size": 256, "n_epochs": 10, "gamma": options.gamma,
                    "learning_rate": options.rate, "ent_coef": 0.01,
                    "policy_kwargs": {"net_arch": [64, 64]}}
        return run_ppo(options.object, seed, options.pushes, settings)
    return run_ours(OURS[method], options.object, seed, options.trials)


# --- all runs -------------------------------------------------------------------------------------


def binned(rows, edges):
    """Mean pushes of the trials that began between two edges of pushes used; NaN without one."""
    means = []
    for low, high in zip(edges, edges[1:]):
        inside = [pushes for used, pushes, _ in rows if low <= used < high]
        means.append(np.mean(inside) if inside else math.nan)
    return means


def curve(runs, edges):
    """For each bin that every run has trials in: pushes used, mean, half of the interval."""
    table = np.array([binned(rows, edges) for rows in runs])
    for i, (low, high) in enumerate(zip(edges, edges[1:])):
        if not np.isnan(table[:, i]).any():
            yield (low + high) / 2, *interval(table[:, i])


def edges_of(most):
    edges = [0]
    while edges[-1] < most:
        edges.append(max(edges[-1] * 1.5, edges[-1] + CAP))  # so each run has trials in each bin
    return edges


def report(results, options):
    most = max(rows[-1][0] for runs in results.values() for rows, _ in runs) + 1
    edges = edges_of(most)
    print(f"{options.object}: pushes to discover, mean and 95% interval over runs")
    for method, runs in results.items():
        rows = [rows for rows, _ in runs]
        capped = sum(not found for run in rows for _, _, found in run) / sum(map(len, rows))
        used = interval([run[-1][0] + run[-1][1] for run in rows])[0]
        print(f"{method}: {len(rows)} runs of {used:.0f} pushes, {100 * capped:.1f}% of trials capped")
        for at, mean, half in curve(rows, edges):
            print(f"  after {at:8.0f} pushes: {mean:5.1f} +- {half:.1f}")
        for kind in runs[0][1]:
            mean, half = interval([np.mean(fresh[kind]) for _, fresh in runs])
            print(f"  {FRESH_TRIALS} fresh trials, {kind}: {mean:.1f} +- {half:.1f}")
    return edges


def write(results, options):
    with open(options.out / "trials.csv", "w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("object", "method", "run", "pushes_used", "pushes", "discovered"))
        for method, runs in results.items():
            for number, (trials, _) in enumerate(runs, 1):
                rows.writerows((options.object, method, number, *trial) for trial in trials)


def draw(results, edges, path, name):
    import matplotlib.pyplot as plt

    _, ax = plt.subplots(figsize=(7.5, 4.2), layout="constrained")
    for method, runs in results.items():
        x, mean, half = map(np.array, zip(*curve([rows for rows, _ in runs], edges)))
        ax.plot(x, mean, color=COLOURS[method], linewidth=2)
        ax.fill_between(x, mean - half, mean + half, color=COLOURS[method], alpha=0.2, linewidth=0)
        ax.annotate("MaskablePPO" if method == PPO else method, (x[-1], mean[-1]), xytext=(5, 0),
                    textcoords="offset points", va="center", color=COLOURS[method])
    ax.set_xscale("log")
    ax.set_ylim(bottom=0)
    ax.set_xlim(right=ax.get_xlim()[1] * 2)
    ax.set_xlabel("pushes used so far")
    ax.set_ylabel(f"pushes to discover {name}")
    ax.spines[["top", "right"]].set_visible(False)
    ax.grid(alpha=0.25)
    ax.figure.savefig(path, metadata={"Date": None})


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, allow_abbrev=False,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--out", required=True, type=pathlib.Path, metavar="DIR", help="folder for the results")
    add("--object", default="RPRPRPR", help="chain, term or file (RPRPRPR)")
    add("--methods", default=",".join([PPO, *OURS]), metavar="NAME,..", help="of all (%(default)s)")
    add("--seed", type=int, default=1, metavar="N", help="run i has the seed 1000 N + i (1)")
    add("--runs", type=int, default=20, metavar="N", help="of each method but MaskablePPO (20)")
    add("--trials", type=int, default=50, metavar="N", help="of such a run (50)")
    add("--ppo-runs", type=int, default=4, metavar="N", help="of MaskablePPO (4)")
    add("--pushes", type=int, default=30000, metavar="N", help="of a run of MaskablePPO (30000)")
    add("--gamma", type=float, default=0.9, help="MaskablePPO's discount (0.9)")
    add("--rate", type=float, default=1e-3, help="MaskablePPO's learning rate (0.001)")
    add("--jobs", type=int, default=1, metavar="N", help="runs at the same time (1)")
    options = parser.parse_args(arguments)
    options.methods = options.methods.split(",")
    for method in options.methods:
        if method not in (*OURS, PPO):
            parser.error(f"--methods: {method}: must be one of {', '.join([*OURS, PPO])}")
    if PPO in options.methods and importlib.util.find_spec("sb3_contrib") is None:
        parser.error("MaskablePPO needs sb3-contrib: pip install './python[bench]', or choose --methods")
    return options


def main(arguments=None):
    options = parse(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ProcessPoolExecutor(
            options.jobs, multiprocessing.get_context("spawn")) as pool:
        started = {method: [pool.submit(one_run, method, experiment.experiment_seed(options.seed, i), options)
                            for i in range(1, (options.ppo_runs if method == PPO else options.runs) + 1)]
                   for method in options.methods}
        results = {method: [run.result() for run in runs] for method, runs in started.items()}
    write(results, options)
    edges = report(results, options)
    draw(results, edges, options.out / "deep_rl.svg", options.object)
    return 0


if __name__ == "__main__":
    sys.exit(main())
