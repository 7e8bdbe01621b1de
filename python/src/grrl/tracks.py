"""A recording of tracked points, whatever it came from."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _check

if TYPE_CHECKING:
    import pandas

_FRAME = ("frame",)
_POINT = ("point", "particle", "track", "id")
_HIDDEN = {"visible": False, "occluded": True}


@dataclass(frozen=True, eq=False)
class Tracks:
    """Points by frame: those of frame 0, then those of frame 1 and so on, by ascending id.

    Made by `from_array`, `from_dataframe` or a reader of `grrl.io`.

    Attributes
    ----------
    ids : (n,) int32
        Which point; a point keeps its number while it stays with its feature.
    xy : (n, 2) float32
        Where it was seen, in `unit`.
    count : (frames,) int32
        How many points each frame shows; their sum is n.
    frames : (frames,) int64
        The number of each frame, ascending.
    unit : str or None
        "px", "mm" or "m"; None: not known.
    pushing : (frames,) bool
        Things move, or nobody knows. By default all frames but the first.
    settled : (frames,) bool
        All lies still after a push: what is believed then counts in what is believed later.
    cleaned : bool
        Points that a tracker had lost were taken away already.
    lost : dict
        How many positions were: "empty", "marked" (0, 0), "frozen".
    warnings : tuple of str
        What a reader found doubtful.
    """

    ids: np.ndarray
    xy: np.ndarray
    count: np.ndarray
    frames: np.ndarray
    unit: str | None = None
    pushing: np.ndarray = None  # type: ignore[assignment]
    settled: np.ndarray = None  # type: ignore[assignment]
    cleaned: bool = False
    lost: dict[str, int] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        def keep(name: str, value: np.ndarray) -> None:
            object.__setattr__(self, name, value)

        keep("ids", np.ascontiguousarray(_check.integers(self.ids, "ids", *_check.INT32), np.int32))
        xy = _check.numbers(self.xy, "xy")
        if xy.shape != (self.ids.size, 2):
            raise ValueError(f"xy must have the shape ({self.ids.size}, 2), as many points as ids, but "
                             f"it has {xy.shape}")
        with np.errstate(over="ignore"):
            keep("xy", np.ascontiguousarray(xy, np.float32))
        if not np.all(np.isfinite(self.xy)):
            raise ValueError("xy must be finite; a point that was not seen is left out")
        keep("count", np.ascontiguousarray(
            _check.integers(self.count, "count", 0, _check.INT32[1]), np.int32))
        n = self.count.size
        if n == 0:
            raise ValueError("a recording needs at least one frame")
        if int(self.count.sum(dtype=np.int64)) != self.ids.size:
            raise ValueError(f"count adds up to {self.count.sum(dtype=np.int64)} points, but there are "
                             f"{self.ids.size} ids")
        keep("frames", np.ascontiguousarray(
            _check.integers(self.frames, "frames", -(2**62), 2**62), np.int64))
        if self.frames.size != n or np.any(np.diff(self.frames) <= 0):
            raise ValueError(f"frames must be {n} ascending numbers, as many as count")
        self._check_order()
        if self.unit is not None:
            _check.one_of(self.unit, "unit", _check.UNITS)
        pushing = np.arange(n) > 0 if self.pushing is None else self.pushing
        settled = np.zeros(n, bool) if self.settled is None else self.settled
        keep("pushing", _check.flags(pushing, "pushing", n))
        keep("settled", _check.flags(settled, "settled", n))

    def _check_order(self) -> None:
        frame = np.repeat(np.arange(self.count.size), self.count)
        same = frame[1:] == frame[:-1]
        wrong = np.flatnonzero(same & (np.diff(self.ids.astype(np.int64)) <= 0))
        if wrong.size:
            i = int(wrong[0])
            twice = self.ids[i] == self.ids[i + 1]
            raise ValueError(f"point {self.ids[i + 1]} of frame {self.frames[frame[i]]} "
                             + ("is there twice; once is right" if twice
                                else "follows a larger id; points of a frame go by ascending id"))

    @classmethod
    def from_array(cls, array: Any, unit: str | None = None, **rest: Any) -> Tracks:
        """Tracks of an array.

        Parameters
        ----------
        array : (frames, points, 2) array of float or int
            Positions in `unit`, NaN for a point that is not seen in a frame.
        unit : {"px", "mm", "m"}, optional
        **rest
            `pushing` and `settled`, (frames,) bool each.
        """
        xy = _check.positions(array, "tracks", "(frames, points, 2)", 3)
        seen = ~np.isnan(xy[..., 0])
        frame, point = np.nonzero(seen)
        del frame
        return cls(ids=point, xy=xy[seen], count=seen.sum(axis=1),
                   frames=np.arange(xy.shape[0]), unit=unit, **rest)

    @classmethod
    def from_dataframe(cls, table: pandas.DataFrame, unit: str | None = None) -> Tracks:
        """Tracks of a table with a row for each point of each frame.

        Parameters
        ----------
        table : pandas.DataFrame
            Columns `frame`, `point` (or `particle`, `track`, `id`), `x` and `y`, or `x_px` and `y_px`;
            perhaps `visible` or `occluded`. Rows in any order. NaN in both positions: not seen.
        unit : {"px", "mm", "m"}, optional
            Of the positions; columns `x_px` and `y_px` are in pixels.
        """
        columns = {str(name).lower(): name for name in table.columns}
        frame_name = _find(columns, _FRAME)
        point_name = _find(columns, _POINT)
        pixels = "x_px" in columns and "y_px" in columns
        names = ("x_px", "y_px") if pixels else ("x", "y")
        x_name, y_name = (_find(columns, (name,)) for name in names)
        frame = _check.integers(table[frame_name].to_numpy(), "the column frame", -(2**62), 2**62)
        point = _check.integers(table[point_name].to_numpy(), "the column point", *_check.INT32)
        if frame.size == 0:
            raise ValueError("the table has no rows")
        xy = np.stack([_column(table, name) for name in (x_name, y_name)], axis=1)
        for name, hidden in _HIDDEN.items():
            if name in columns:
                xy[table[columns[name]].to_numpy().astype(bool) == hidden] = np.nan
        xy = _check.positions(xy, "positions", "(rows, 2)", 2)
        order = np.lexsort((point, frame))
        frame, point, xy = frame[order], point[order], xy[order]
        twice = np.flatnonzero((np.diff(frame) == 0) & (np.diff(point) == 0))
        if twice.size:
            i = int(twice[0])
            raise ValueError(f"point {point[i]} of frame {frame[i]} is there twice; once is right")
        numbers, index = np.unique(frame, return_inverse=True)
        seen = ~np.isnan(xy[:, 0])
        count = np.bincount(index[seen], minlength=numbers.size)
        empty = int(np.count_nonzero(~seen)) if not set(_HIDDEN) & set(columns) else 0
        return cls(ids=point[seen], xy=xy[seen], count=count, frames=numbers,
                   unit="px" if pixels and unit is None else unit, lost={"empty": empty})

    def to_array(self) -> tuple[np.ndarray, np.ndarray]:
        """The positions as one array, and whose each column is.

        Returns
        -------
        array : (frames, points, 2) float64
            In `unit`, NaN where a point is not seen.
        ids : (points,) int32
        """
        ids, column = np.unique(self.ids, return_inverse=True)
        array = np.full((self.count.size, ids.size, 2), np.nan)
        array[np.repeat(np.arange(self.count.size), self.count), column] = self.xy
        return array, ids

    def __repr__(self) -> str:
        return (f"Tracks({self.count.size} frames, {np.unique(self.ids).size} points, "
                f"unit={self.unit!r})")


def _find(columns: dict[str, Any], names: tuple[str, ...]) -> Any:
    for name in names:
        if name in columns:
            return columns[name]
    raise ValueError(f"the table has no column {' or '.join(names)}; it has {', '.join(columns)}; "
                     "needed are frame, point, x and y (or x_px and y_px)")


def _column(table: pandas.DataFrame, name: Any) -> np.ndarray:
    try:
        return table[name].to_numpy(dtype=np.float64, na_value=np.nan)
    except (TypeError, ValueError):
        raise TypeError(f"the column {name} must hold numbers, but its dtype is "
                        f"{table[name].dtype}") from None


def as_tracks(tracks: Any, unit: str | None = None) -> Tracks:
    """Tracks of whatever `grrl.perceive` takes."""
    if isinstance(tracks, Tracks):
        return tracks
    if hasattr(tracks, "columns") and hasattr(tracks, "to_numpy"):
        return Tracks.from_dataframe(tracks, unit)
    if isinstance(tracks, (str, bytes)) or hasattr(tracks, "__fspath__"):
        raise TypeError("tracks must be an array, a DataFrame or Tracks; grrl.io.from_csv reads a file")
    return Tracks.from_array(tracks, unit)
