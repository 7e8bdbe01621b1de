"""The simulator's truth beside a log of it: the same world is simulated again, push for push.

No log and no message holds the truth. A world of grrl-sim is the same bit for bit for an object, a
seed and pushes, so it can be had again from these; that the points of the log agree is checked.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..learner import Push as Command
from ..world import Supervisor, World
from .run import PUSHING, Run

_WRONG_M = 0.01  # half of the points further off than this: another world


@dataclass
class Truth:
    """object, seed: as given to grrl-sim; sizes: (length, width) of each link, m; joints: (a, b,
    type); poses: for each frame of the run (links, 3): x, y (m), angle (rad)."""

    object: str
    seed: int
    sizes: list[list[float]]
    joints: list[tuple[int, int, str]]
    poses: list[np.ndarray]


def _compare(run: Run, number: int, world: World, what: str) -> None:
    frame, seen = run.frames[number], world.observe()
    place = np.minimum(np.searchsorted(seen.ids, frame.ids), len(seen) - 1)
    same = seen.ids[place] == frame.ids
    off = np.linalg.norm(seen.points[place[same]] - frame.xy[same], axis=1)
    if off.size < 4 or np.median(off) > _WRONG_M:
        apart = f"{1000 * np.median(off):.0f} mm" if off.size else "all of them"
        raise ValueError(f"--truth: this log is not one of grrl-sim with {what}, without --camera: in "
                         f"trial {run.trials[frame.trial].id} half of the points lie more than {apart} "
                         "from where they should be")


def truth_of(run: Run, object: str, seed: int) -> Truth:
    """What the simulator knew.

    Raises
    ------
    ValueError
        There is no such object, or the log is not of this object and seed.
    ImportError
        This build of grrl has no simulated world.
    """
    supervisor = Supervisor(object)
    pushes = {(push.trial, push.cmd): push for push in run.pushes}
    truth = Truth(object, seed, [], supervisor.joints, [])
    world: World | None = None
    trial = done = -1
    for number, frame in enumerate(run.frames):
        if frame.trial != trial or world is None:
            world = World(object, seed, run.trials[frame.trial].id, noise=0.0)
            trial, done = frame.trial, 0
            truth.sizes = Supervisor.sizes(world).tolist()
            _compare(run, number, world, f"--object {object} --seed {seed}")
        if frame.ack != done:
            done = frame.ack
            push = pushes.get((trial, done))
            if push is None or push.start is None or push.end is None:
                raise ValueError(f"--truth: the log lacks the command of push {done} of trial "
                                 f"{run.trials[trial].id}")
            world.begin_push(Command(push.start, push.end, push.travel, push.speed, push.force,
                                     push.timeout))
        if frame.phase == PUSHING:
            world.step()
        truth.poses.append(Supervisor.poses(world))
        if frame.phase != PUSHING and (number == 0 or run.frames[number - 1].phase == PUSHING):
            _compare(run, number, world, f"--object {object} --seed {seed}")
    return truth
