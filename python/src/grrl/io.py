"""Readers: what other programs write, as Tracks."""

from __future__ import annotations

import os
import struct
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _check, _native
from .tracks import Tracks

if TYPE_CHECKING:
    import pandas

__all__ = ["from_csv", "from_deeplabcut", "from_lcm_log", "from_opencv", "from_tapir", "from_trackpy"]


def from_csv(path: str | os.PathLike[str], unit: str | None = None) -> Tracks:
    """A file with a row for each point of each frame, exactly as `grrl-perceive` reads it.

    Parameters
    ----------
    path : str or path
        The header names the columns frame,point,x,y (or x_px,y_px) and perhaps visible.
    unit : {"px", "mm", "m"}, optional
        Of the positions; columns x_px and y_px are in pixels.

    Raises
    ------
    ValueError
        "FILE:LINE:COLUMN: what is wrong and what would be right".
    OSError
        The file cannot be read.
    """
    raw = _native.read_csv(os.fsencode(path))
    if raw["in_pixels"] and unit is None:
        unit = "px"
    return Tracks(ids=raw["id"], xy=np.stack([raw["x"], raw["y"]], axis=1), count=raw["count"],
                  frames=raw["number"], unit=unit, cleaned=True, lost={**raw["lost"]})


def from_opencv(points: Any, status: Any = None, unit: str = "px") -> Tracks:
    """Points of `cv2.calcOpticalFlowPyrLK`, frame by frame.

    Parameters
    ----------
    points : (frames, points, 2) or (frames, points, 1, 2) array of float
        What OpenCV returned for each frame, pixels; or a list of (points, 1, 2) arrays.
    status : (frames, points) or (frames, points, 1) array, optional
        1 where a point was found. Once it is lost it stays lost.
    unit : {"px", "mm", "m"}
    """
    array = _check.numbers(points, "points")
    if array.ndim == 4 and array.shape[2] == 1:
        array = array[:, :, 0, :]
    xy = _check.positions(array, "points", "(frames, points, 2) or (frames, points, 1, 2)", 3).copy()
    if status is not None:
        found = np.asarray(status)
        if found.ndim == 3 and found.shape[2] == 1:
            found = found[:, :, 0]
        if found.shape != xy.shape[:2] or found.dtype.kind not in "biu":
            raise ValueError(f"status must be whole numbers of shape {xy.shape[:2]}, not {found.dtype} "
                             f"of shape {found.shape}")
        xy[~np.logical_and.accumulate(found != 0, axis=0)] = np.nan
    return Tracks.from_array(xy, unit)


def from_deeplabcut(table: pandas.DataFrame | str | os.PathLike[str], likelihood: float = 0.6) -> Tracks:
    """A table of DeepLabCut: a column group for each body part.

    Parameters
    ----------
    table : DataFrame or path
        Columns of two or three (or four, with several animals) levels, the last of them x, y and
        likelihood; or a CSV or HDF5 file of that.
    likelihood : float
        A position below it counts as not seen.
    """
    likelihood = _check.real(likelihood, "likelihood", 0.0, 1.0)
    if isinstance(table, (str, os.PathLike)):
        table = _read_deeplabcut(os.fspath(table))
    if getattr(table.columns, "nlevels", 1) < 2:
        raise ValueError("a table of DeepLabCut has several header rows (scorer, bodyparts, coords); "
                         "this one has a single one: see grrl.io.from_csv")
    parts: dict[Any, dict[str, int]] = {}
    for place, name in enumerate(table.columns):
        parts.setdefault(name[:-1], {})[name[-1]] = place
    arrays = []
    for part, places in parts.items():
        if not {"x", "y"} <= set(places):
            raise ValueError(f"the body part {part[-1]} needs the columns x and y; it has "
                             f"{', '.join(map(str, places))}")
        xy = table.iloc[:, [places["x"], places["y"]]].to_numpy(np.float64, copy=True)
        if "likelihood" in places:
            sure = table.iloc[:, places["likelihood"]].to_numpy(np.float64)
            xy[~(sure >= likelihood)] = np.nan
        xy[np.isnan(xy).any(axis=1)] = np.nan
        arrays.append(xy)
    return Tracks.from_array(np.stack(arrays, axis=1) if arrays else np.empty((0, 0, 2)), "px")


def _read_deeplabcut(path: str) -> pandas.DataFrame:
    import pandas

    if path.endswith((".h5", ".hdf5")):
        return pandas.read_hdf(path)
    with open(path, encoding="utf-8") as file:
        rows = [line.split(",")[0].strip() for _, line in zip(range(4), file)]
    levels = [i for i, name in enumerate(rows)
              if name in ("scorer", "individuals", "bodyparts", "coords")]
    if "coords" not in rows:
        raise ValueError(f"{path}: a file of DeepLabCut begins with rows named scorer, bodyparts and "
                         "coords; see grrl.io.from_csv for other tables")
    return pandas.read_csv(path, header=levels, index_col=0)


def from_trackpy(table: pandas.DataFrame, unit: str = "px") -> Tracks:
    """Trajectories of `trackpy.link`.

    Parameters
    ----------
    table : DataFrame
        With the columns frame, particle, x and y, in any order of rows.
    unit : {"px", "mm", "m"}
    """
    if "particle" not in getattr(table, "columns", ()):
        raise ValueError("a table of trackpy has the columns frame, particle, x and y; has "
                         "trackpy.link been called?")
    return Tracks.from_dataframe(table[["frame", "particle", "x", "y"]], unit)


def from_tapir(tracks: Any, visible: Any, size: tuple[float, float] | None = None) -> Tracks:
    """Tracks of TAPIR, TAPNet, BootsTAPIR or CoTracker.

    Parameters
    ----------
    tracks : (points, frames, 2) array of float
        x and y in pixels, or normalised to 0 .. 1 when `size` is given. CoTracker's are (frames,
        points, 2): transpose them first.
    visible : (points, frames) array of bool
        Where a point is seen.
    size : (width, height), optional
        Of the picture, pixels: the tracks are normalised.
    """
    xy = _check.positions(tracks, "tracks", "(points, frames, 2)", 3).copy()
    seen = np.asarray(visible)
    if seen.dtype != np.bool_ or seen.shape != xy.shape[:2]:
        raise ValueError(f"visible must be booleans of shape {xy.shape[:2]}, not {seen.dtype} of shape "
                         f"{seen.shape}")
    if size is not None:
        if np.shape(size) != (2,):
            raise ValueError("size must be (width, height) in pixels")
        xy *= np.array([_check.real(side, "size", 1, 1e6) for side in size], np.float32)
    xy[~seen] = np.nan
    return Tracks.from_array(xy.transpose(1, 0, 2), "px")


# --- LCM logs -----------------------------------------------------------------------------------

_SYNC = b"\xed\xa1\xda\x01"
_EVENT = struct.Struct(">4sqqII")
_POINTS = struct.Struct(">QqqqiiqbbI")
_CHANNEL = b"GRRL_POINTS"
_REST, _SETTLED = 1, 3
_MAX_POINTS = 256
_MAX_DATA = 1 << 24


_POINTS_MEMBERS = (
    ("utime", "int64_t", ""), ("session_id", "int64_t", ""), ("seq", "int64_t", ""),
    ("trial_id", "int32_t", ""), ("ack_cmd_seq", "int32_t", ""), ("agent_session_id", "int64_t", ""),
    ("mode", "int8_t", ""), ("phase", "int8_t", ""), ("n_points", "int32_t", ""),
    ("id", "int32_t", "n_points"), ("x", "float", "n_points"), ("y", "float", "n_points"))


def _fingerprint(members: tuple[tuple[str, str, str], ...] = _POINTS_MEMBERS) -> int:
    """Of a message, as lcm-gen computes it: of the names, types and dimensions of its members."""
    value = 0x12345678

    def add(byte: int) -> None:
        nonlocal value
        signed = value - (1 << 64) if value >> 63 else value
        value = (((value << 8) & (2**64 - 1)) ^ ((signed >> 55) & (2**64 - 1))) + byte & (2**64 - 1)

    def add_text(text: str) -> None:
        for byte in (len(text), *text.encode()):
            add(byte)

    for name, kind, count in members:
        add_text(name)
        add_text(kind)
        add(1 if count else 0)  # dimensions
        if count:
            add(0 if count.isdigit() else 1)  # a number, or the name of a member
            add_text(count)
    return ((value << 1) & (2**64 - 1)) + (value >> 63) & (2**64 - 1)


def _events(data: bytes) -> Any:
    """Channel, bytes and time (us) of each whole event; None where some are damaged."""
    at = 0
    while at < len(data):
        whole = len(data) - at >= _EVENT.size
        if whole:
            sync, _, time, n_channel, n_data = _EVENT.unpack_from(data, at)
            begin = at + _EVENT.size
            end = begin + n_channel + n_data
            next_sync = data[end:end + 4]
            whole = (sync == _SYNC and 0 < n_channel < 1000 and n_data <= _MAX_DATA
                     and end <= len(data) and next_sync == _SYNC[:len(next_sync)])
        if whole:
            yield data[begin:begin + n_channel], data[begin + n_channel:end], time
            at = end
        else:
            yield None
            at = data.find(_SYNC, at + 1)
            if at < 0:
                return


def _points(data: bytes) -> tuple[tuple[int, ...], np.ndarray, np.ndarray] | None:
    """session, seq, trial, phase; ids; positions. None: not a message of this type, or damaged."""
    if len(data) < _POINTS.size:
        return None
    fingerprint, _, session, seq, trial, _, _, _, phase, n = _POINTS.unpack_from(data)
    if fingerprint != _FINGERPRINT or n > _MAX_POINTS or len(data) != _POINTS.size + 12 * n:
        return None
    ids = np.frombuffer(data, ">i4", n, _POINTS.size)
    xy = np.frombuffer(data, ">f4", 2 * n, _POINTS.size + 4 * n).reshape(2, n).T
    if session < 1 or seq < 1 or trial < 0 or not 0 <= phase <= 3 or not np.all(np.abs(xy) <= 1000):
        return None
    return (session, seq, trial, phase), ids, xy


def _choose_session(frames: list[Any], trial: int | None) -> tuple[int, bool, int]:
    """Of several senders one after the other the last, of mixed ones the one with most messages."""
    sessions = [key[0] for key, _, _ in frames]
    turns = [s for i, s in enumerate(sessions) if i == 0 or sessions[i - 1] != s]
    mixed = len(turns) != len(set(turns))
    able = [s for s in dict.fromkeys(sessions)
            if trial is None or any(k[0] == s and k[2] == trial for k, _, _ in frames)]
    if not able:
        return 0, mixed, len(set(turns))
    return (max(able, key=sessions.count) if mixed else able[-1]), mixed, len(set(turns))


def from_lcm_log(path: str | os.PathLike[str], trial: int | None = None) -> Tracks:
    """One trial of an LCM log with the channel GRRL_POINTS; in metres.

    Parameters
    ----------
    path : str or path
        As grrl-sim --log or lcm-logger writes it. What is damaged is left out, with a warning.
    trial : int, optional
        By default the last one. Of several senders the last one's messages are read, of mixed ones
        those of the sender with most.
    """
    if trial is not None:
        trial = _check.whole(trial, "trial", 0, 2**31 - 1)
    with open(path, "rb") as file:
        data = file.read()
    frames, refused, damaged = [], 0, 0
    for event in _events(data):
        if event is None:
            damaged += 1
        elif event[0] == _CHANNEL:
            message = _points(event[1])
            refused += message is None
            frames += [message] if message else []
    name = os.fspath(path)
    if not frames:
        raise ValueError(f"{name}: an LCM log with messages on GRRL_POINTS is needed, "
                         + (f"all {refused} of this one are damaged" if refused else "this has none"))
    session, mixed, senders = _choose_session(frames, trial)
    if trial is None:
        trial = next((key[2] for key, _, _ in reversed(frames) if key[0] == session), 0)
    kept, last = [], 0
    for frame in frames:
        if frame[0][0] == session and frame[0][2] == trial and frame[0][1] > last:
            kept.append(frame)
            last = frame[0][1]
    if not kept:
        raise ValueError(f"{name}: no points of trial {trial}; leave trial away for the last one")
    warnings = []
    if refused:
        warnings.append(f"{refused} damaged messages left out")
    if damaged:
        warnings.append(f"the log is damaged in {damaged} places: frames may be missing")
    if senders > 1:
        warnings.append(f"{senders} sessions{', mixed' if mixed else ''}; only {session} is read")
    return _tracks_of(kept, tuple(warnings))


def _tracks_of(frames: list[Any], warnings: tuple[str, ...]) -> Tracks:
    order = [np.argsort(ids, kind="stable") for _, ids, _ in frames]
    phase = np.array([key[3] for key, _, _ in frames])
    return Tracks(ids=np.concatenate([ids[o] for (_, ids, _), o in zip(frames, order)]),
                  xy=np.concatenate([xy[o] for (_, _, xy), o in zip(frames, order)]),
                  count=np.array([ids.size for _, ids, _ in frames]),
                  frames=np.array([key[1] for key, _, _ in frames]), unit="m",
                  pushing=(phase != _REST) & (phase != _SETTLED) & (np.arange(phase.size) > 0),
                  settled=phase == _SETTLED, cleaned=True, warnings=warnings)


_FINGERPRINT = _fingerprint()
