"""The simulated world, and apart from it the supervisor, who alone knows the truth."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from . import _check, _native
from .learner import Learner, Push
from .model import TYPES, Model

if _native.HAS_WORLD:
    _native.set_object_folder(os.path.join(os.path.dirname(__file__), "objects"))

_MAX_LOOKS = 10  # at a scene in which the learner finds nothing to push


def _need_world() -> None:
    if not _native.HAS_WORLD:
        raise ImportError(
            "this build of grrl has no simulated world: Box2D 2.4 was not there when it was built. "
            "Debian: apt-get install libbox2d-dev, then pip install --force-reinstall ./python")


def trial_seed(seed: int, trial: int) -> int:
    """The seed of a world: each trial of a seed has its own pose of the object, noise and friction.

    Parameters
    ----------
    seed : int
        0 to 2**64 - 1; as `grrl-sim --seed`.
    trial : int
        From 1.
    """
    _need_world()
    return _native.trial_seed(_check.whole(seed, "seed", 0, 2**64 - 1),
                              _check.whole(trial, "trial", 0, 2**31 - 1))


@dataclass(frozen=True)
class PushResult:
    """What came of a push.

    Attributes
    ----------
    reason : {"reached", "missed", "blocked", "timeout", "refused"}
    touched : bool
    duration : float
        Seconds.
    travelled : float
        Metres after the first contact.
    start, end : tuple of float
        Where the finger came down and was lifted, metres.
    why : str
        Of a refused push: what is wrong about it and what would be right.
    """

    reason: str
    touched: bool
    duration: float
    travelled: float
    start: tuple[float, float]
    end: tuple[float, float]
    why: str = ""


class World:
    """A table seen from above, with an object, a finger that pushes it and a camera (Box2D).

    The same object, seed and pushes give the same frames bit for bit. Nothing here tells the truth
    about the object; a `Supervisor` does.

    Parameters
    ----------
    object : str
        A chain ("RPRPRPR"), a term ("R(l1, R(l2, l3))"), the name of an object that comes with grrl
        ("wooden-toy") or the path of a file.
    seed : int
        0 to 2**64 - 1.
    trial : int, optional
        As trial of a run of grrl-sim with this seed: the world's seed is `trial_seed(seed, trial)`.
    noise : float
        Standard deviation of a point, per axis, metres.
    dropout, outliers : float
        Probabilities of a point to be missing, or elsewhere, in a frame.
    """

    def __init__(self, object: str, seed: int = 1, trial: int | None = None, *,
                 noise: float = 0.0007, dropout: float = 0.0, outliers: float = 0.0) -> None:
        _need_world()
        if not isinstance(object, str):
            raise TypeError(f"object must be a text such as 'RPRPRPR', not {type(object).__name__}")
        seed = _check.whole(seed, "seed", 0, 2**64 - 1)
        if trial is not None:
            seed = trial_seed(seed, trial)
        self._native = _native.World(object, seed, _check.real(noise, "noise", 0.0, 0.1),
                                     _check.real(dropout, "dropout", 0.0, 1.0),
                                     _check.real(outliers, "outliers", 0.0, 1.0))

    def observe(self) -> _native.Frame:
        """What the camera sees now; fresh noise in every call."""
        return self._native.observe()

    def begin_push(self, push: Push) -> str:
        """Starts a push. Returns why not, or an empty text."""
        if not isinstance(push, Push):
            raise TypeError(f"push must be a grrl.Push, not {type(push).__name__}")
        return self._native.begin_push(_pair(push.start, "start"), _pair(push.end, "end"),
                                       *(_check.real(getattr(push, name), name, -1e6, 1e6)
                                         for name in ("travel", "speed", "force", "timeout")))

    def step(self) -> bool:
        """Advances 1/30 s. Whether the push still goes on or the object has not come to rest yet."""
        return self._native.step()

    def push(self, push: Push) -> tuple[PushResult, list[_native.Frame]]:
        """A whole push.

        Returns
        -------
        result : PushResult
        frames : list of Frame
            Those of the push until the object has come to rest; none of a refused one.
        """
        why = self.begin_push(push)
        if why:
            return PushResult("refused", False, 0.0, 0.0, push.start, push.end, why), []
        frames, moving = [], True
        while moving:
            moving = self.step()
            frames.append(self.observe())
        return self.result, frames

    @property
    def result(self) -> PushResult:
        """Of the last push that is over."""
        return PushResult(*self._native.push_result())

    @property
    def time(self) -> float:
        """Seconds since the world began."""
        return self._native.time_s()

    @property
    def state_hash(self) -> int:
        """Of every position and velocity, bit for bit: equal runs have equal hashes."""
        return self._native.state_hash()


def _pair(value: Any, name: str) -> tuple[float, float]:
    if np.shape(value) != (2,):
        raise ValueError(f"{name} must be x and y in metres, not {value!r}")
    return (_check.real(value[0], name, -1e6, 1e6), _check.real(value[1], name, -1e6, 1e6))


@dataclass(frozen=True)
class Verdict:
    """How a believed structure differs from the true one: positive is missing, negative too many."""

    correct: bool
    undecided: bool
    missing_links: int
    missing_revolute: int
    missing_prismatic: int
    text: str

    def __bool__(self) -> bool:
        return self.correct


class Supervisor:
    """Knows the true structure and ends a trial when it has been found.

    Parameters
    ----------
    object : str
        As for `World`.
    """

    def __init__(self, object: str) -> None:
        _need_world()
        if not isinstance(object, str):
            raise TypeError(f"object must be a text such as 'RPRPRPR', not {type(object).__name__}")
        self._native = _native.Supervisor(object)

    def judge(self, believed: Learner | Model) -> Verdict:
        """Compares links and joints, not the properties of links."""
        if isinstance(believed, Learner):
            return Verdict(*self._native.judge_learner(believed._native))
        if not isinstance(believed, Model):
            raise TypeError(f"judge takes a Learner or a Model, not {type(believed).__name__}")
        joints = [(joint.a, joint.b, TYPES.index(joint.type)) for joint in believed.joints]
        return Verdict(*self._native.judge(len(believed.bodies), joints))

    @property
    def links(self) -> int:
        """How many the object has, without what is glued to the table."""
        return self._native.links()

    @property
    def joints(self) -> list[tuple[int, int, str]]:
        """The links of each joint, and its type."""
        return [(a, b, TYPES[kind]) for a, b, kind in self._native.joints()]

    @staticmethod
    def poses(world: World) -> np.ndarray:
        """(links, 3) float64: x and y in metres and the angle in radians of each link, now."""
        return _native.true_poses(world._native)

    @staticmethod
    def sizes(world: World) -> np.ndarray:
        """(links, 2) float64: length and width of each link, metres."""
        return _native.true_sizes(world._native)

    @staticmethod
    def joint_values(world: World) -> np.ndarray:
        """(joints,) float64: radians or metres of each joint, now."""
        return _native.true_joint_values(world._native)

    @staticmethod
    def link_of_point(world: World) -> np.ndarray:
        """(points,) int32: the link that each point lies on, by id; -1: the table."""
        return _native.true_link_of_point(world._native)

    @staticmethod
    def wrong_joints(world: World, learner: Learner) -> list[tuple[str, str, str]]:
        """Believed joints that the object has not: the names of their bodies, and their type."""
        return [(f"f{a}", f"f{b}", TYPES[kind])
                for a, b, kind in _native.wrong_joints(world._native, learner._native)]


@dataclass(frozen=True)
class TrialResult:
    """How a trial went.

    Attributes
    ----------
    trial : int
    pushes : int
    discovered : bool
        Or capped.
    wrong_joints : int
        Ever believed in the trial though the object has none such.
    actions : list of (str, int)
        The body and the direction (index) of each push.
    rewards : list of float
    """

    trial: int
    pushes: int
    discovered: bool
    wrong_joints: int
    actions: list[tuple[str, int]] = field(default_factory=list)
    rewards: list[float] = field(default_factory=list)


def settle(learner: Learner, world: World) -> bool:
    """Frames at rest, and what they tell; whether anything was seen."""
    for _ in range(_native.SETTLING_FRAMES):
        learner._native.observe(world._native.observe(), False)
    return learner.perceive()


def carry_out(learner: Learner, world: World, push: Push) -> str:
    """A push that the learner sees, and the rest after it. Why it was refused, or an empty text."""
    see, look, step = learner._native.observe, world._native.observe, world._native.step
    why = world.begin_push(push)
    moving = not why
    while moving:
        moving = step()
        see(look(), True)
    settle(learner, world)
    return why


def run_trial(learner: Learner, object: str, trial: int = 1, *, seed: int | None = None,
              cap: int = 100, noise: float = 0.0007) -> TrialResult:
    """Lets a learner find out an object's structure: one trial, as `grrl-experiment` runs it.

    Parameters
    ----------
    learner : Learner
        It keeps what it learns.
    object : str
        As for `World`.
    trial : int
        From 1.
    seed : int, optional
        Of the world; the learner's by default.
    cap : int
        Pushes after which the trial is given up.
    noise : float
        Of a point, metres; the learner should assume as much.
    """
    _check.whole(trial, "trial", 1, 2**31 - 1)
    supervisor = Supervisor(object)
    world = World(object, learner.seed if seed is None else seed, trial, noise=noise)
    cap = _check.whole(cap, "cap", 1, 1_000_000)
    learner.begin_trial(trial)
    settle(learner, world)
    wrong = set(supervisor.wrong_joints(world, learner))
    actions: list[tuple[str, int]] = []
    rewards: list[float] = []
    found, looks = False, 0
    while not found and len(actions) < cap:
        decision = learner.choose()
        if decision is None:
            looks += 1
            if looks > _MAX_LOOKS:
                raise RuntimeError("the learner finds nothing to push; less noise would help")
            settle(learner, world)
            continue
        looks = 0
        carry_out(learner, world, decision.push)
        actions.append((decision.body, decision.direction))
        wrong.update(supervisor.wrong_joints(world, learner))
        found = supervisor.judge(learner).correct
        rewards.append(learner.learn(found).reward)
    return TrialResult(int(trial), len(actions), found, len(wrong), actions, rewards)
