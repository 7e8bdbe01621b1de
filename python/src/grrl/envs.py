"""Gymnasium: finding out an object's structure as a task, "grrl/Discover-v0"."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from . import _check, _native
from .learner import Learner
from .model import TYPES, Model
from .raster import picture_of
from .world import Supervisor, World, carry_out, settle

_LINKS = _native.MAX_LINKS
_DIRECTIONS = len(_native.DIRECTIONS_DEG)
_FAR_M = 20.0
_MAX_TRIED = 255


class DiscoverEnv(gymnasium.Env):
    """One trial: push an object until its structure is known.

    An action is `link * 6 + direction`, an index into the links seen and into `grrl.DIRECTIONS_DEG`;
    `info["action_mask"]` and `action_masks()` tell which links there are. A push at a link that is not
    there moves nothing and counts. The reward is the number of links and joints revealed, and 1 more
    when the structure is found. `terminated`: found; `truncated`: `cap` pushes were made.

    `reset(seed=s)` begins trial 1 of the seed s of grrl-sim, each `reset()` after it the next trial;
    `options={"trial": n}` goes to trial n. The same seed and actions give the same run as in the C++
    programs.

    The observation is what perception believes, never the truth:

    - `links` (MAX_LINKS, 8) float32: x, y (m), unit vectors of the directions 0 and 90 degrees, length
      and width (m)
    - `link_mask` (MAX_LINKS,) int8: which rows of `links` are there
    - `joints` (2, MAX_LINKS, MAX_LINKS) float32: probability of the revolute and prismatic joints
    - `tried` (MAX_LINKS, 6) uint8: how often each push was made in this trial
    - `points` (MAX_FEATURES, 3) float32 with `points=True`: x, y (m) and link, -1 for none; rows
      beyond those seen are (0, 0, -2)

    Parameters
    ----------
    object : str
        As for `grrl.World`.
    cap : int
        Pushes in a trial.
    noise : float
        Standard deviation of a point, metres.
    points : bool
        Whether the observation has the points, too.
    render_mode : {"rgb_array"}, optional
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 2}

    def __init__(self, object: str = "RPRPRPR", cap: int = 100, noise: float = 0.0007,
                 points: bool = False, render_mode: str | None = None) -> None:
        if render_mode is not None:
            _check.one_of(render_mode, "render_mode", ("rgb_array",))
        self.render_mode = render_mode
        self._object = object
        self._cap = _check.whole(cap, "cap", 1, 1_000_000)
        self._noise = _check.real(noise, "noise", 0.0, 0.1)
        self._points = bool(points)
        self._supervisor = Supervisor(object)
        self._learner = Learner("random", noise=self._noise)
        self._world: World | None = None
        self._model: Model | None = None
        self._seed: int | None = None
        self._trial = 0
        self.action_space = spaces.Discrete(_LINKS * _DIRECTIONS)
        self.observation_space = spaces.Dict(self._spaces())

    def _spaces(self) -> dict[str, spaces.Space[Any]]:
        found: dict[str, spaces.Space[Any]] = {
            "links": spaces.Box(-_FAR_M, _FAR_M, (_LINKS, 8), np.float32),
            "link_mask": spaces.MultiBinary(_LINKS),
            "joints": spaces.Box(0.0, 1.0, (len(TYPES), _LINKS, _LINKS), np.float32),
            "tried": spaces.Box(0, _MAX_TRIED, (_LINKS, _DIRECTIONS), np.uint8),
        }
        if self._points:
            found["points"] = spaces.Box(-_FAR_M, max(_FAR_M, _LINKS), (_native.MAX_FEATURES, 3),
                                         np.float32)
        return found

    def reset(self, *, seed: int | None = None,
              options: dict[str, Any] | None = None) -> tuple[dict[str, Any], dict[str, Any]]:
        super().reset(seed=seed)
        if seed is not None or self._seed is None:
            self._seed = int(self.np_random.integers(2**31)) if seed is None else int(seed)
            self._trial = 0
        self._trial += 1
        if options and "trial" in options:
            self._trial = _check.whole(options["trial"], "trial", 1, 2**31 - 1)
        self._world = World(self._object, self._seed, self._trial, noise=self._noise)
        self._pushes = 0
        self._done = False
        self._tried: dict[tuple[int, int], int] = {}
        self._learner.begin_trial(self._trial)
        settle(self._learner, self._world)
        self._model = self._learner.model
        return self._observation(), self._info(True)

    def step(self, action: Any) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        if self._world is None or self._model is None or self._done:
            raise gymnasium.error.ResetNeeded("step: the trial is over or has not begun; call reset")
        link, direction = divmod(_check.whole(action, "action", 0, _LINKS * _DIRECTIONS - 1),
                                 _DIRECTIONS)
        self._pushes += 1
        valid = link < len(self._model.bodies)
        reward, found = 0.0, False
        if valid:
            number = self._model.bodies[link].number
            decision = self._learner.adopt(number, direction)
            carry_out(self._learner, self._world, decision.push)
            found = self._supervisor.judge(self._learner).correct
            reward = self._learner.learn(found).reward
            self._tried[number, direction] = self._tried.get((number, direction), 0) + 1
            self._model = self._learner.model
        elif not self._model.bodies:  # nothing is seen that could be pushed: look again
            settle(self._learner, self._world)
            self._model = self._learner.model
        truncated = not found and self._pushes >= self._cap
        self._done = found or truncated
        return self._observation(), reward, found, truncated, self._info(valid)

    def action_masks(self) -> np.ndarray:
        """(MAX_LINKS * 6,) bool: the pushes there are; as sb3-contrib's MaskablePPO asks for it."""
        n = 0 if self._model is None else len(self._model.bodies)
        return np.arange(_LINKS * _DIRECTIONS) < n * _DIRECTIONS

    def _info(self, valid: bool) -> dict[str, Any]:
        assert self._model is not None
        return {"action_mask": self.action_masks().astype(np.int8), "term": self._model.term,
                "trial": self._trial, "pushes": self._pushes, "valid": valid}

    def _observation(self) -> dict[str, Any]:
        model = self._model
        assert model is not None
        links = np.zeros((_LINKS, 8), np.float32)
        mask = np.zeros(_LINKS, np.int8)
        joints = np.zeros((len(TYPES), _LINKS, _LINKS), np.float32)
        tried = np.zeros((_LINKS, _DIRECTIONS), np.uint8)
        for i, body in enumerate(model.bodies):
            links[i] = (*body.centroid, *body.frame.ravel(), body.length, body.width)
            mask[i] = 1
            for direction in range(_DIRECTIONS):
                tried[i, direction] = min(self._tried.get((body.number, direction), 0), _MAX_TRIED)
        for joint in model.joints:
            kind = TYPES.index(joint.type)
            joints[kind, [joint.a, joint.b], [joint.b, joint.a]] = joint.probability
        found = {"links": np.clip(links, -_FAR_M, _FAR_M), "link_mask": mask,
                 "joints": np.clip(joints, 0.0, 1.0), "tried": tried}
        if self._points:
            points = np.tile(np.array([0.0, 0.0, -2.0], np.float32), (_native.MAX_FEATURES, 1))
            points[:model.ids.size, :2] = np.clip(model.positions, -_FAR_M, _FAR_M)
            points[:model.ids.size, 2] = np.maximum(model.body_of, -1)
            found["points"] = points
        return found

    def render(self) -> np.ndarray | None:
        """(height, width, 3) uint8: the points by believed link, pivots and axes."""
        if self.render_mode is None or self._model is None:
            return None
        return picture_of(self._model)


def register() -> None:
    """Makes "grrl/Discover-v0" known; `import grrl` does it."""
    gymnasium.register("grrl/Discover-v0", entry_point="grrl.envs:DiscoverEnv")
