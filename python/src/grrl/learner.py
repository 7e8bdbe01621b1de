"""The learner: perception, a policy, and pushes in metres and newtons."""

from __future__ import annotations

import os
import tempfile
from dataclasses import dataclass
from typing import Any

from . import _check, _native
from .model import Model, model_from
from .perception import frame_of
from .policy import Adapter, Policy

_REASONS = ("random", "explore", "exploit", "adopted", "rule")
_SOURCES = ("none", "exact", "relaxed", "substructure", "cases")
_REASON_WORDS = ("at random", "new action", "best bound", "adopted", "by rule")
_SOURCE_WORDS = ("nothing", "the same structure", "the same structure, properties dropped",
                 "a sub-structure", "all cases")
_LEAST_NOISE_M = 0.00005  # to assume: no camera has none
_OWN_STORE = b"grrl python policy 1\n"


@dataclass(frozen=True)
class Push:
    """A push as a robot takes it: come down at `start`, move towards `end`, stop `travel` after the
    first contact, at the end of the line, or after the timeout.

    Attributes
    ----------
    start, end : tuple of float
        x and y, metres.
    travel : float
        Metres after the first contact.
    speed : float
        Metres a second.
    force : float
        Limit, newtons.
    timeout : float
        Seconds.
    """

    start: tuple[float, float]
    end: tuple[float, float]
    travel: float = 0.03
    speed: float = 0.08
    force: float = 10.0
    timeout: float = 2.5


@dataclass(frozen=True)
class Decision:
    """What to push, how, and why.

    Attributes
    ----------
    body : str
        "f3".
    link : int
        Index into the model's bodies.
    direction : int
        Index into `grrl.DIRECTIONS_DEG`.
    push : Push
    reason : {"random", "explore", "exploit", "adopted", "rule"}
    source : {"none", "exact", "relaxed", "substructure", "cases"}
        What the estimate comes from.
    value, lower, upper : float
        Estimated reward (or Q value) and its confidence bounds; 0 without a source.
    phi : float
        Share of the state's actions with experience.
    index : int
        Of the closest experience or case, -1 without one.
    distance : int
        Links and joints (for cases: parts of the context) that differ from it.
    """

    body: str
    link: int
    direction: int
    push: Push
    reason: str
    source: str
    value: float
    lower: float
    upper: float
    phi: float
    index: int
    distance: int

    @property
    def direction_deg(self) -> int:
        return _native.DIRECTIONS_DEG[self.direction]

    def __str__(self) -> str:
        """In words, as `grrl-agent --explain`."""
        text = (f"{self.body} at {self.direction_deg} deg, "
                f"{_REASON_WORDS[_REASONS.index(self.reason)]}")
        if self.source != "none":
            text += (f" {self.value:.2f} ({self.lower:.2f} to {self.upper:.2f}) from "
                     f"{_SOURCE_WORDS[_SOURCES.index(self.source)]}, closest {self.index} at distance "
                     f"{self.distance}")
        return f"{text}; phi {self.phi:.2f}"


@dataclass(frozen=True)
class Update:
    """What was learned from a push.

    Attributes
    ----------
    reward : float
        Links and joints revealed; at the trial's end also its reward.
    target : float
        What the estimate moved towards.
    index : int
        The entry updated, -1: none.
    """

    reward: float
    target: float
    index: int


@dataclass(frozen=True)
class Usage:
    """How full a policy's memory is: entries, room for, and how many were evicted."""

    n: int
    capacity: int
    evictions: int


class Learner:
    """Learns which pushes tell most about an object's structure.

    For each trial: `begin_trial`; `observe` every frame at rest; `perceive`; then again and again
    `choose` (or `adopt`), the push with `observe` for every frame, more frames at rest, `perceive`,
    `learn`. `grrl.run_trial` does that with a simulated world.

    Parameters
    ----------
    policy : str or Policy
        One of `grrl.POLICIES` ("learn", "paper", "greedy", "random"), or an object of your own with
        `choose(view, random)`; see `grrl.Policy`.
    seed : int
        0 to 2**64 - 1. The same seed, frames and outcomes give the same choices.
    noise : float
        Standard deviation of a tracked point, per axis, metres.
    capacity : int
        Entries a policy of the library can hold, 1 to 1,000,000.
    large : float
        Links at least this long (metres) are called large.
    trial_reward : float
        Added to the last reward of a trial.
    **parameters
        Of a policy of the library, by name, such as `alpha`.
    """

    def __init__(self, policy: str | Policy = "learn", *, seed: int = 1, noise: float = 0.0007,
                 capacity: int = 1000, large: float = 0.15, trial_reward: float = 1.0,
                 **parameters: float) -> None:
        self.seed = _check.whole(seed, "seed", 0, 2**64 - 1)
        options = {
            "seed": self.seed,
            "noise_m": max(_LEAST_NOISE_M, _check.real(noise, "noise", 0.0, 1.0)),
            "capacity": _check.whole(capacity, "capacity", 1, 1_000_000),
            "large_m": _check.real(large, "large", 1e-6, 1000.0),
            "trial_reward": _check.real(trial_reward, "trial_reward", 0.0, 1000.0),
        }
        adapter = None
        self._own: Any = None
        if isinstance(policy, str):
            _check.one_of(policy, "policy", tuple(_native.POLICIES))
        else:
            adapter, self._own = Adapter(policy), policy
            if parameters:
                raise TypeError(f"a policy of your own takes no parameters: {', '.join(parameters)}")
        for name, value in parameters.items():
            parameters[name] = _check.real(value, name, -1e30, 1e30)
        name = policy if isinstance(policy, str) else ""
        self._native = _native.Learner(name, adapter, options, parameters)

    def begin_trial(self, trial: int) -> None:
        """Starts with a new object or a new pose; abandons an unfinished trial.

        Parameters
        ----------
        trial : int
            From 1; the random numbers start from (seed, trial).
        """
        self._native.begin_trial(_check.whole(trial, "trial", 0, 2**31 - 1))

    def observe(self, frame: _native.Frame | Any, ids: Any = None, *, pushing: bool = False) -> None:
        """Takes one frame.

        Parameters
        ----------
        frame : Frame, or (n, 2) array of float
            Of a `World`, or positions in metres, NaN for a point that is not seen.
        ids : (n,) array of int, optional
            Whose they are, for an array; 0 .. n - 1 by default.
        pushing : bool
            The robot is acting, or things move.
        """
        if not isinstance(frame, _native.Frame):
            frame = frame_of(frame, ids, "m")
        self._native.observe(frame, bool(pushing))

    def perceive(self) -> bool:
        """Brings the model up to date; at rest. False: nothing was seen yet."""
        return self._native.perceive()

    def choose(self) -> Decision | None:
        """The next push. None: there is no link to push; look again in further frames."""
        raw = self._native.choose()
        return None if raw is None else _decision(raw)

    def adopt(self, body: str | int, direction: int) -> Decision:
        """Takes a push somebody else chose, so that its outcome is learned.

        Parameters
        ----------
        body : str or int
            "f3" or 3.
        direction : int
            Index into `grrl.DIRECTIONS_DEG`.
        """
        if isinstance(body, str):
            if not body.startswith("f") or not body[1:].isdigit():
                raise ValueError(f"body must be such as 'f3', not {body!r}")
            body = int(body[1:])
        number = _check.whole(body, "body", 0, 65535)
        return _decision(self._native.adopt(number, _check.whole(direction, "direction", 0, 5)))

    def learn(self, ended: bool) -> Update:
        """Learns from the outcome of the last choice; after `perceive`.

        Parameters
        ----------
        ended : bool
            The supervisor ends the trial: its reward is added and nothing follows.
        """
        return Update(*self._native.learn(bool(ended)))

    def abandon(self) -> None:
        """Forgets the trial; nothing is learned from a push without an outcome."""
        self._native.abandon()

    @property
    def model(self) -> Model:
        """What perception believes, in metres."""
        return model_from(self._native.model(), "m")

    @property
    def term(self) -> str:
        """The believed structure, D(lb, ..)."""
        return self._native.term()

    @property
    def usage(self) -> Usage:
        """How full the policy's memory is; zeros for one that does not learn."""
        return Usage(*self._native.usage())

    @property
    def learns(self) -> bool:
        """Whether there is something to save."""
        if self._own is not None:
            return hasattr(self._own, "save") and hasattr(self._own, "load")
        return self.usage.capacity > 0

    def to_bytes(self) -> bytes:
        """What the policy learned; for a policy of the library as in a file of grrl-agent."""
        if not self.learns:
            raise ValueError("this policy does not learn: there is nothing to save")
        if self._own is not None:
            return _OWN_STORE + bytes(self._own.save())
        return self._native.save()

    def from_bytes(self, store: bytes) -> None:
        """Replaces what was learned. ValueError: not a store of this policy, damaged, or too large."""
        if not isinstance(store, (bytes, bytearray, memoryview)):
            raise TypeError(f"a store is bytes, not {type(store).__name__}")
        if not self.learns:
            raise ValueError("this policy does not learn: it has no use for a store")
        store = bytes(store)
        if self._own is None:
            self._native.load(store)
        elif store.startswith(_OWN_STORE):
            self._own.load(store[len(_OWN_STORE):])
        else:
            raise ValueError("load: this is no store of a policy of Python")

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes what was learned to a file, whole or not at all; `grrl-agent --store` reads it."""
        store = self.to_bytes()
        folder = os.path.dirname(os.fspath(path)) or "."
        handle, temporary = tempfile.mkstemp(dir=folder, prefix=".grrl-", suffix=".new")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(store)
                file.flush()
                os.fsync(file.fileno())
            os.replace(temporary, path)
        except BaseException:
            os.unlink(temporary)
            raise

    def load(self, path: str | os.PathLike[str]) -> None:
        """Reads what was learned from a file of `save` or `grrl-agent --store`."""
        with open(path, "rb") as file:
            store = file.read()
        try:
            self.from_bytes(store)
        except ValueError as error:
            raise ValueError(f"{os.fspath(path)}: {error}") from None

    def clear(self) -> None:
        """Forgets all that was learned, for a policy of the library."""
        self._native.clear()


def _decision(raw: dict[str, Any]) -> Decision:
    return Decision(f"f{raw['number']}", raw["link"], raw["direction"], Push(*raw["push"]),
                    _REASONS[raw["reason"]], _SOURCES[raw["source"]], raw["value"], raw["lower"],
                    raw["upper"], raw["phi"], raw["index"], raw["distance"])

