"""From tracked points to links and joints."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import _check, _native
from .model import Model, model_from
from .tracks import Tracks, as_tracks

if TYPE_CHECKING:
    import pandas

_MEASURED = -1.0
_MAX_NOISE = 1e6


def _noise(noise: float | str | None) -> float:
    """As the extension module wants it: 0 is the profile's, -1 is measured."""
    if noise is None:
        return 0.0
    if isinstance(noise, str):
        if noise != "auto":
            raise ValueError(f"noise must be 'auto', a number above 0 or None, not {noise!r}")
        return _MEASURED
    value = _check.real(noise, "noise", 0.0, _MAX_NOISE)
    if value < 1e-9:
        raise ValueError("noise must be above 0: the standard deviation of a point, in the unit of the "
                         "tracks")
    return value


def _in_python(warning: str) -> str:
    """The words of grrl-perceive, as a caller from Python knows them."""
    return (warning.replace("give --unit m", "give unit='m'").replace("See --unit", "See unit=")
            .replace("--unit", "unit="))


def perceive(tracks: np.ndarray | pandas.DataFrame | Tracks, unit: str | None = None,
             noise: float | str | None = "auto", *, profile: str | None = None,
             motion: bool = True, drop_lost: bool = True, rectify: Any = None) -> Model:
    """Finds the links and joints of what the points lie on, by how they move.

    Parameters
    ----------
    tracks : (frames, points, 2) array of float or int, DataFrame or Tracks
        Positions in `unit`, NaN for a point that is not seen in a frame; or a table with the columns
        frame, point, x, y; or what a reader of `grrl.io` gives. The first frame is taken as rest and
        all others as one push, unless the tracks say otherwise.
    unit : {"px", "mm", "m"}
        Of the positions. Needed unless the tracks know it.
    noise : float, "auto" or None
        Standard deviation of a point in one frame, per axis, in `unit`. "auto" measures it from the
        points; None takes the profile's (tracker 0.7 mm, camera 1 px).
    profile : {"tracker", "camera"}, optional
        What the noise is like; by default the camera for pixels, else the tracker.
    motion : bool
        Whether to work out how each joint moves in each frame.
    drop_lost : bool
        Whether to take away positions that a tracker goes on writing after it has lost a point:
        (0, 0), (-1, -1), or one repeated exactly.
    rectify : (4, 4) array of float or int, optional
        Four points of the table, each a row (pixel x, pixel y, table x, table y): the tracks are then
        in pixels of a camera that stands still, and `unit` ("mm" or "m") is that of the table, of
        `noise` and of the answer.

    Returns
    -------
    Model
        All lengths in `unit`, angles in radians.

    Raises
    ------
    ValueError, TypeError
        What is wrong about an argument, and what would be right.
    """
    recording = as_tracks(tracks, unit)
    said = unit is not None
    unit = unit if said else recording.unit
    if unit is None:
        raise ValueError("unit is needed: 'px', 'mm' or 'm', what the positions are in")
    places = [] if rectify is None else _check.places(rectify, "rectify")
    if places:
        unit = _check.one_of(unit, "unit (with rectify, of the table)", ("mm", "m"))
        profile = _check.one_of(profile or "camera", "profile", _check.PROFILES)
    else:
        unit, profile = _check.unit_and_profile(unit, profile)
    lost = recording.lost
    drop_lost = bool(drop_lost) and not recording.cleaned
    raw = _native.perceive(
        recording.ids, np.ascontiguousarray(recording.xy[:, 0]),
        np.ascontiguousarray(recording.xy[:, 1]), recording.count, recording.frames,
        recording.pushing, recording.settled, unit, profile, _noise(noise),
        (lost.get("empty", 0), lost.get("marked", 0), lost.get("frozen", 0)), drop_lost, said,
        bool(motion), places)
    warnings = recording.warnings + tuple(_in_python(text) for text in raw["warnings"])
    return model_from(raw, unit, frames=recording.frames, profile=profile, noise=raw["noise"],
                      counts={**raw["counts"]}, warnings=warnings)


class Perception:
    """Perception frame by frame, for one who knows when things are at rest.

    Parameters
    ----------
    unit : {"px", "mm", "m"}
        Of the points.
    noise : float or None
        Standard deviation of a point in one frame, per axis, in `unit`; None: the profile's.
    profile : {"tracker", "camera"}, optional

    Examples
    --------
    >>> import numpy as np
    >>> perception = Perception(unit="mm", noise=0.7)
    >>> perception.observe(np.random.default_rng(1).normal(0, 50, (12, 2)), pushing=False)
    >>> perception.update().term
    'D(lb, L(s, f1))'
    """

    def __init__(self, unit: str = "m", noise: float | None = None,
                 profile: str | None = None) -> None:
        self.unit, self.profile = _check.unit_and_profile(unit, profile)
        value = _noise(noise)
        if value == _MEASURED:
            raise ValueError("noise='auto' needs a whole recording: see grrl.perceive; give a number")
        self._native = _native.Perception(self.unit, self.profile, value)

    def observe(self, points: Any, ids: Any = None, *, pushing: bool = False) -> None:
        """Takes one frame.

        Parameters
        ----------
        points : (n, 2) array of float or int
            Positions in `unit`, NaN for a point that is not seen.
        ids : (n,) array of int, optional
            Whose they are; 0 .. n - 1 by default. No id twice.
        pushing : bool
            The robot is acting, or things move.
        """
        self._native.observe(frame_of(points, ids, self.unit), bool(pushing))

    def update(self) -> Model:
        """Works out bodies and joints from all frames so far; at rest.

        Returns
        -------
        Model
            Without bodies while no point was seen.
        """
        self._native.update()
        return self.model

    @property
    def model(self) -> Model:
        """The result of the last update; empty before the first."""
        raw = self._native.model()
        return model_from(raw, self.unit, profile=self.profile, noise=raw["noise"],
                          counts={**raw["counts"]})

    def reset(self) -> None:
        """Forgets the object: what follows is a new one."""
        self._native.reset()


def frame_of(points: Any, ids: Any, unit: str) -> _native.Frame:
    """A frame of the extension module, in metres."""
    array = _check.numbers(points, "points")
    if array.size == 0 and array.shape in ((0,), (0, 2)):
        xy = np.empty((0, 2), np.float32)
    else:
        xy = _check.positions(array, "points", "(n, 2)", 2)
    if ids is None:
        numbers = np.arange(xy.shape[0], dtype=np.int32)
    else:
        numbers = _check.integers(ids, "ids", *_check.INT32).astype(np.int32)
        if numbers.size != xy.shape[0]:
            raise ValueError(f"ids must be {xy.shape[0]}, one for each point, not {numbers.size}")
        if np.unique(numbers).size != numbers.size:
            raise ValueError("ids must differ: one id is there twice")
    seen = ~np.isnan(xy[:, 0])
    metres = np.float32(_check.METRES[unit])
    x, y = (np.ascontiguousarray(xy[seen, k] * metres) for k in (0, 1))
    return _native.Frame(np.ascontiguousarray(numbers[seen]), x, y)
