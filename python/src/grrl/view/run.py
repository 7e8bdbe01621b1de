"""What was on the bus as a run that can be shown: frames, models, pushes and trials, in order."""

from __future__ import annotations

import mmap
import os
from collections import Counter
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from .. import _native
from ..io import _events
from . import wire

REST, PUSHING, SETTLED = 1, 2, 3
_REAL_TIME = 0
_MOVING, _DONE, _REFUSED = 1, 2, 3
_PUSH = 1
# Stages of a push, seen from a frame.
NONE, COMING, UNDER_WAY, OVER = range(4)
_FRAME_S = 1 / 30  # of a world that stands still until it is answered
_LONGEST_S = 0.5
_READING_S = 0.9  # how long a decision is shown before its push begins
_SILENT_US = 1_000_000  # then another session may take over
MAX_FRAMES = 30_000  # that are kept of a live run

REASONS = ("at random", "new action", "best bound", "adopted", "by rule")
SOURCES = ("nothing", "the same structure", "the same structure, properties dropped",
           "a sub-structure", "all cases")
RESULTS = ("", "reached", "missed", "blocked", "timeout", "refused")
OUTCOMES = ("", "discovered", "capped", "aborted")
STOPS = ("operator", "limit", "collision", "fault")


@dataclass
class Link:
    """A believed link: the n of its fn, centre (m), angle of its long axis (rad), sizes (m)."""

    n: int
    x: float
    y: float
    angle: float
    length: float
    width: float


@dataclass
class Joint:
    """a, b: indices of links; x, y: the pivot, or a point on the axis (m); angle: of the axis (rad);
    lower, upper: excursion seen (rad or m)."""

    a: int
    b: int
    type: str
    p: float
    x: float
    y: float
    angle: float
    lower: float
    upper: float


@dataclass
class ModelSeen:
    """What the agent believes after push `cmd` of a trial (an index into Run.trials)."""

    trial: int
    cmd: int
    term: str
    links: list[Link]
    joints: list[Joint]
    ids: np.ndarray  # (n,) int32, ascending
    link_of: np.ndarray  # (n,) int8: index of a link, -1 background, -2 nothing known
    at: np.ndarray = field(default_factory=lambda: np.empty((0, 2), np.float32))  # then; NaN: unseen
    places: tuple[np.ndarray, ...] = ()  # of motion_of


@dataclass
class Push:
    """A push: why it was chosen, where it goes (m), and what came of it."""

    trial: int
    cmd: int
    why: str = ""
    link: int = 0
    direction: int = 0
    value: float | None = None
    lower: float | None = None
    upper: float | None = None
    phi: float | None = None
    start: tuple[float, float] | None = None
    end: tuple[float, float] | None = None
    travel: float = 0.0
    speed: float = 0.0
    force: float = 0.0
    timeout: float = 0.0
    result: str = ""
    reward: float | None = None


@dataclass
class Trial:
    """id: as on the wire, 0 without a supervisor; pushes so far; outcome: "" while it goes on."""

    id: int
    pushes: int = 0
    outcome: str = ""


@dataclass
class Frame:
    """The points at one time. t: seconds of the show; trial, model, push: indices, -1: none; phase
    and ack: as on the wire; stage: of that push; ids (n,) int32 ascending, xy (n, 2) float32 m; motion (links, 3) float32: how each
    link of the model has moved since: x, y (m) and angle (rad) of p' = R p + t."""

    t: float
    trial: int
    ids: np.ndarray
    xy: np.ndarray
    phase: int = 0
    ack: int = 0
    stage: int = NONE
    model: int = -1
    push: int = -1
    motion: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.float32))


def _places(model: ModelSeen, ids: np.ndarray) -> tuple[np.ndarray, ...]:
    """ids; which of them lie on which link (links, n); how many; where they were, 0 for the others.
    Kept, for most frames see the same points."""
    if model.places and np.array_equal(model.places[0], ids):
        return model.places
    place = np.minimum(np.searchsorted(model.ids, ids), model.ids.size - 1)
    at = model.at[place]
    good = (model.ids[place] == ids) & ~np.isnan(at[:, 0])
    on = ((model.link_of[place] == np.arange(len(model.links))[:, None]) & good).astype(np.float64)
    model.places = (ids, on, on.sum(axis=1), np.where(good, at.T, 0.0).astype(np.float64))
    return model.places


def motion_of(model: ModelSeen, ids: np.ndarray, xy: np.ndarray) -> np.ndarray:
    """(links, 3): the rigid motion of each link since the model; least squares over its points.
    A link with fewer than two points seen takes no motion."""
    n = len(model.links)
    if n == 0 or ids.size == 0 or model.at.shape[0] == 0:
        return np.zeros((n, 3), np.float32)
    _, on, count, (px, py) = _places(model, ids)
    qx, qy = xy.T.astype(np.float64)
    sums = on @ np.stack([px, py, qx, qy, px * qx + py * qy, px * qy - py * qx], axis=1)
    mpx, mpy, mqx, mqy, dot, cross = sums.T / np.maximum(count, 1)
    angle = np.arctan2(cross - (mpx * mqy - mpy * mqx), dot - (mpx * mqx + mpy * mqy))
    c, s = np.cos(angle), np.sin(angle)
    motion = np.stack([mqx - (c * mpx - s * mpy), mqy - (s * mpx + c * mpy), angle], axis=1)
    motion[count < 2] = 0
    return motion.astype(np.float32)


class Run:
    """A run as it was heard. `add` takes messages in order.

    Attributes
    ----------
    frames, models, pushes, trials : list
    heard : Counter
        Messages by channel; refused and other_schema: of those.
    foreign : int
        Messages of another session while the shown one was alive.
    status : dict
        The newest agent_status_t.
    stopped : str
        Why, once GRRL_STOP was heard.
    dropped : int
        How often the oldest frames were dropped, and indices changed.
    """

    def __init__(self, least_gap_us: int = 0, max_frames: int | None = None) -> None:
        self.frames: list[Frame] = []
        self.models: list[ModelSeen] = []
        self.pushes: list[Push] = []
        self.trials: list[Trial] = []
        self.heard: Counter[str] = Counter()
        self.refused: Counter[str] = Counter()
        self.other_schema: Counter[str] = Counter()
        self.foreign = 0
        self.damaged = 0
        self.status: dict[str, Any] = {}
        self.stopped = ""
        self.dropped = 0
        self._gap_us, self._max = least_gap_us, max_frames
        self._session = self._agent = 0
        self._heard_us: int | None = None
        self._seq = self._utime = 0
        self._shown_us = -(1 << 62)
        self._shown_as: tuple[int, ...] = ()
        self._trial_of: dict[tuple[int, int], int] = {}
        self._push_of: dict[tuple[int, int], int] = {}
        self._moving = False
        self._trial = self._model = self._push = -1

    # --- what comes in

    def add(self, channel: str, data: bytes, time_us: int) -> bool:
        """A message as it was heard at time_us; whether it changed anything."""
        self.heard[channel] += 1
        name = wire.CHANNELS.get(channel)
        if name is None:
            return False
        try:
            message = wire.decode(name, data)
        except wire.OtherSchema:
            self.other_schema[channel] += 1
            return False
        except ValueError:
            self.refused[channel] += 1
            return False
        take = getattr(self, "_take_" + name[:-2])
        return bool(take(message, time_us))

    def _from_plant(self, session: int, time_us: int) -> bool:
        """Whether a tracker, robot or supervisor is the one shown; another may take over."""
        if session != self._session:
            silent = (self._heard_us is None or time_us - self._heard_us > _SILENT_US
                      or time_us < self._heard_us)
            if not silent:
                self.foreign += 1
                return False
            self._session, self._agent, self._seq, self._moving = session, 0, 0, False
            self._trial = self._model = self._push = -1
        self._heard_us = time_us
        return True

    def _from_agent(self, session: int) -> bool:
        if self._agent not in (0, session):
            self.foreign += 1
            return False
        return True

    def _enter(self, trial_id: int) -> int:
        """The index of a trial of this session, a new one if need be."""
        key = (self._session, trial_id)
        if key not in self._trial_of:
            self._trial_of[key] = len(self.trials)
            self.trials.append(Trial(trial_id))
        index = self._trial_of[key]
        if index != self._trial:
            self._trial, self._model, self._push, self._moving = index, -1, -1, False
        return index

    def _take_points(self, m: dict[str, Any], time_us: int) -> bool:
        if not self._from_plant(m["session_id"], time_us) or m["seq"] <= self._seq:
            return False
        new_kind = (m["trial_id"], m["ack_cmd_seq"], m["phase"])
        self._seq = m["seq"]
        if (new_kind == self._shown_as and 0 <= time_us - self._shown_us < self._gap_us
                and m["phase"] != SETTLED):
            return False
        self._shown_as, self._shown_us = new_kind, time_us
        trial = self._enter(m["trial_id"])
        if m["ack_cmd_seq"] > 0:
            self.trials[trial].pushes = max(self.trials[trial].pushes, m["ack_cmd_seq"])
        xy = np.empty((m["id"].size, 2), np.float32)
        order = np.argsort(m["id"], kind="stable")
        xy[:, 0], xy[:, 1] = m["x"][order], m["y"][order]
        frame = Frame(self._time_of(m), trial, m["id"][order], xy, m["phase"], m["ack_cmd_seq"])
        self.frames.append(frame)
        self._refer()
        if self._max and len(self.frames) > self._max:
            self._forget()
        return True

    def _time_of(self, m: dict[str, Any]) -> float:
        since = (m["utime"] - self._utime) / 1e6
        self._utime = m["utime"]
        if not self.frames:
            return 0.0
        step = _FRAME_S if m["mode"] != _REAL_TIME else min(max(since, 0.0), _LONGEST_S)
        return self.frames[-1].t + (_READING_S if self.frames[-1].stage == COMING else step)

    def _refer(self) -> None:
        """The last frame shows what is known by now."""
        if not self.frames or self.frames[-1].trial != self._trial:
            return
        frame = self.frames[-1]
        if frame.model != self._model or not frame.motion.size:
            frame.model = self._model
            frame.motion = (motion_of(self.models[self._model], frame.ids, frame.xy)
                            if self._model >= 0 else np.empty((0, 3), np.float32))
        frame.push, frame.stage = self._push, self._stage()

    def _stage(self) -> int:
        if self._push < 0:
            return NONE
        push, frame = self.pushes[self._push], self.frames[-1]
        if frame.ack > 0 or frame.phase != 0:
            if push.cmd > frame.ack:
                return COMING
            return UNDER_WAY if frame.phase == PUSHING else OVER
        return UNDER_WAY if self._moving else OVER if push.result else COMING

    def _take_trial(self, m: dict[str, Any], time_us: int) -> bool:
        if not self._from_plant(m["session_id"], time_us):
            return False
        trial = self._enter(m["trial_id"])
        outcome = OUTCOMES[m["outcome"]] if m["phase"] != 0 else ""
        changed = outcome != self.trials[trial].outcome and bool(outcome)
        if changed:
            self.trials[trial].outcome = outcome
        return changed

    def _take_model(self, m: dict[str, Any], _: int) -> bool:
        if not self._from_agent(m["session_id"]):
            return False
        trial = self._trial_of.get((self._session, m["trial_id"]), -1)
        if trial < 0 or trial != self._trial:
            return False
        if self._model >= 0 and self.models[self._model].cmd == m["cmd_seq"]:
            return False
        self.models.append(self._seen(trial, m))
        self._model = len(self.models) - 1
        self._refer()
        return True

    def _seen(self, trial: int, m: dict[str, Any]) -> ModelSeen:
        links = [Link(int(n), *(float(v) for v in rest)) for n, *rest in zip(
            m["link_number"], m["link_x"], m["link_y"], m["link_angle"], m["link_length"],
            m["link_width"])]
        joints = [Joint(int(a), int(b), "prismatic" if t else "revolute", *(float(v) for v in rest))
                  for a, b, t, *rest in zip(
                      m["joint_a"], m["joint_b"], m["joint_type"], m["joint_probability"],
                      m["joint_x"], m["joint_y"], m["joint_angle"], m["joint_lower"],
                      m["joint_upper"])]
        try:
            term = _native.term_of_structure([int(n) for n in m["link_number"]],
                                             [bool(s == 2) for s in m["link_size"]],
                                             [(int(a), int(b), int(t)) for a, b, t in zip(
                                                 m["joint_a"], m["joint_b"], m["joint_type"])])
        except ValueError as error:
            term = f"no term: {error}"
        order = np.argsort(m["feature_id"], kind="stable")
        seen = ModelSeen(trial, m["cmd_seq"], term, links, joints, m["feature_id"][order],
                         m["feature_link"][order])
        seen.at = np.full((seen.ids.size, 2), np.nan, np.float32)
        frame = self.frames[-1] if self.frames and self.frames[-1].trial == trial else None
        if frame is not None and seen.ids.size:
            place = np.minimum(np.searchsorted(seen.ids, frame.ids), seen.ids.size - 1)
            known = seen.ids[place] == frame.ids
            seen.at[place[known]] = frame.xy[known]
        return seen

    def _push_record(self, trial_id: int, cmd: int) -> Push | None:
        trial = self._trial_of.get((self._session, trial_id), -1)
        if trial < 0 or trial != self._trial:
            return None
        if (trial, cmd) not in self._push_of:
            self._push_of[trial, cmd] = len(self.pushes)
            self.pushes.append(Push(trial, cmd))
        self._push = max(self._push, self._push_of[trial, cmd])
        return self.pushes[self._push_of[trial, cmd]]

    def _take_decision(self, m: dict[str, Any], _: int) -> bool:
        if not self._from_agent(m["session_id"]):
            return False
        push = self._push_record(m["trial_id"], m["cmd_seq"])
        if push is None:
            return False
        push.why, push.link, push.direction = _why(m), m["link_number"], m["direction_deg"]
        push.phi = m["phi"]
        if m["source"]:
            push.value, push.lower, push.upper = m["value"], m["lower"], m["upper"]
        before = self._push_of.get((push.trial, push.cmd - 1))
        if before is not None:
            self.pushes[before].reward = m["last_reward"]
        self._refer()
        return True

    def _take_push_command(self, m: dict[str, Any], _: int) -> bool:
        if m["plant_session_id"] != self._session:
            self.foreign += self._session != 0
            return False
        self._agent = m["session_id"]
        if m["kind"] != _PUSH or m["cmd_seq"] < 1:
            return False
        push = self._push_record(m["trial_id"], m["cmd_seq"])
        if push is None or push.start is not None:
            return False
        push.start, push.end = m["start"], m["end"]
        push.travel, push.speed, push.force = m["travel"], m["speed"], m["force"]
        push.timeout = m["timeout"]
        self._refer()
        return True

    def _take_push_status(self, m: dict[str, Any], _: int) -> bool:
        trial = self._trial_of.get((self._session, m["trial_id"]), -1)
        index = self._push_of.get((trial, m["cmd_seq"]))
        if index is None or trial != self._trial:
            return False
        self._moving = m["state"] == _MOVING
        result = {_DONE: RESULTS[m["reason"]] or "done", _REFUSED: "refused"}.get(m["state"], "")
        changed = bool(result) and self.pushes[index].result != result
        if changed:
            self.pushes[index].result = result
            done = sum(p.trial == trial and bool(p.result) for p in self.pushes[-200:])
            self.trials[trial].pushes = max(self.trials[trial].pushes, done)
        self._refer()
        return changed

    def _take_agent_status(self, m: dict[str, Any], _: int) -> bool:
        self.status = m
        return True

    def _take_stop(self, m: dict[str, Any], _: int) -> bool:
        self.stopped = STOPS[m["reason"]]
        return True

    # --- what is dropped, and what was wrong

    def _forget(self) -> None:
        """Drops the older half of the frames, and what only they showed."""
        del self.frames[:len(self.frames) // 2]
        self.dropped += 1
        models = min((f.model for f in self.frames if f.model >= 0), default=len(self.models))
        pushes = min((f.push for f in self.frames if f.push >= 0), default=len(self.pushes))
        del self.models[:models], self.pushes[:pushes]
        for frame in self.frames:
            frame.model = max(frame.model - models, -1)
            frame.push = max(frame.push - pushes, -1)
        self._model, self._push = max(self._model - models, -1), max(self._push - pushes, -1)
        self._push_of = {key: i - pushes for key, i in self._push_of.items() if i >= pushes}

    def only(self, trial_id: int) -> Run:
        """One trial, with the pushes of all for the curve; of several with its number the last.

        Raises
        ------
        ValueError
            There is no such trial.
        """
        wanted = max((i for i, t in enumerate(self.trials) if t.id == trial_id), default=-1)
        frames = [f for f in self.frames if f.trial == wanted]
        if not frames:
            raise ValueError(f"no trial {trial_id} with points; there are "
                             + ", ".join(sorted({str(t.id) for t in self.trials}, key=int)))
        run = Run()
        run.trials = self.trials
        models = next((i for i, m in enumerate(self.models) if m.trial == wanted), 0)
        pushes = next((i for i, p in enumerate(self.pushes) if p.trial == wanted), 0)
        run.models = [m for m in self.models if m.trial == wanted]
        run.pushes = [p for p in self.pushes if p.trial == wanted]
        run.frames = [replace(f, t=f.t - frames[0].t, model=max(f.model - models, -1),
                              push=max(f.push - pushes, -1)) for f in frames]
        return run

    def warnings(self) -> list[str]:
        """What the viewer should know about the messages."""
        lines = []
        for channel, n in sorted(self.other_schema.items()):
            lines.append(f"{n} messages on {channel} are of another version of grrl, or no "
                         f"{wire.CHANNELS[channel]}: left out")
        for channel, n in sorted(self.refused.items()):
            lines.append(f"{n} damaged messages on {channel}: left out")
        if self.foreign:
            lines.append(f"{self.foreign} messages of other sessions: left out")
        if self.damaged:
            lines.append(f"the log is damaged in {self.damaged} places: messages may be missing")
        return lines


def _why(m: dict[str, Any]) -> str:
    """As `grrl-agent --explain` says it."""
    text = REASONS[m["reason"]]
    if m["source"]:
        text += (f" {m['value']:.2f} ({m['lower']:.2f} to {m['upper']:.2f}) from {SOURCES[m['source']]}, "
                 f"closest {m['source_index']} at distance {m['distance']}")
    return text


def add_log(run: Run, data: bytes | mmap.mmap) -> None:
    """All messages of an LCM log, or of a part of one that begins with an event."""
    for event in _events(data):
        if event is None:
            run.damaged += 1
        else:
            run.add(event[0].decode("utf-8", "replace"), event[1], event[2])


def read_log(path: str | os.PathLike[str]) -> Run:
    """The run of an LCM log, as grrl-sim --log or lcm-logger writes it.

    Raises
    ------
    ValueError
        There is nothing in it that could be shown, and why.
    OSError
        It cannot be read.
    """
    run = Run()
    name = os.fspath(path)
    with open(path, "rb") as file:
        if os.fstat(file.fileno()).st_size == 0:
            raise ValueError(f"{name}: the log is empty")
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            add_log(run, data)
    if not run.frames:
        raise ValueError(f"{name}: {_nothing(run)}")
    return run


def _nothing(run: Run) -> str:
    """Why a log without a single frame has none."""
    need = "an LCM log with points_t on GRRL_POINTS is needed"
    if not run.heard:
        return f"this is no LCM log; {need}"
    if run.other_schema["GRRL_POINTS"] or run.refused["GRRL_POINTS"]:
        return f"{need}; {'; '.join(run.warnings())}"
    if run.heard["GRRL_IMAGE"]:
        return (f"{need}, this one has pictures only: record what grrl-track publishes, with "
                "lcm-logger")
    heard = ", ".join(f"{name} ({n})" for name, n in run.heard.most_common(5))
    return f"{need}, this one has {heard}"
