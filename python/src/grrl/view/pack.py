"""A run as bytes for the page: a JSON header and columns of whole numbers, deflated; and the page."""

from __future__ import annotations

import base64
import importlib.resources
import json
import re
import struct
import zlib
from dataclasses import asdict
from typing import Any

import numpy as np

from ..plot import COLOURS
from .run import Frame, ModelSeen, Run

LENGTH_M = 0.00025  # a unit of a length, and of an angle (rad)
ANGLE_RAD = 0.0001
_TIME_S = 0.001


def _round(value: Any) -> Any:
    """Numbers short enough to print, for JSON."""
    if isinstance(value, float):
        return round(value, 5)
    if isinstance(value, (list, tuple)):
        return [_round(v) for v in value]
    if isinstance(value, dict):
        return {key: _round(v) for key, v in value.items()}
    return value


def model_json(model: ModelSeen) -> dict[str, Any]:
    return {"trial": model.trial, "cmd": model.cmd, "term": model.term,
            "links": [_round(asdict(link)) for link in model.links],
            "joints": [_round(asdict(joint)) for joint in model.joints],
            "ids": model.ids.tolist(), "link_of": model.link_of.tolist()}


def record_json(record: Any) -> dict[str, Any]:
    """A Push or a Trial."""
    return _round(asdict(record))


def _whole(values: np.ndarray, unit: float) -> np.ndarray:
    return np.rint(values / unit).astype(np.int64).astype(np.int32)


def _motion(frame: Frame) -> np.ndarray:
    return _whole(frame.motion, np.array([LENGTH_M, LENGTH_M, ANGLE_RAD])).ravel()


def frame_json(frame: Frame) -> dict[str, Any]:
    xy = _whole(frame.xy, LENGTH_M)
    return {"t": round(frame.t, 3), "trial": frame.trial, "model": frame.model, "push": frame.push,
            "stage": frame.stage, "ids": frame.ids.tolist(), "x": xy[:, 0].tolist(),
            "y": xy[:, 1].tolist(), "motion": _motion(frame).tolist()}


def _planes(values: np.ndarray) -> bytes:
    """Signs in the lowest bit, then all lowest bytes, all second ones, ..: small numbers deflate."""
    v = values.astype(np.int32)
    folded = ((v << 1) ^ (v >> 31)).astype("<i4")
    return folded.view(np.uint8).reshape(-1, 4).T.tobytes()


def _rows(rows: list[np.ndarray]) -> np.ndarray:
    """Each row less the one before, where both are as long."""
    out = [row - before if row.size == before.size else row
           for before, row in zip([np.empty(0, np.int32), *rows[:-1]], rows)]
    return np.concatenate(out) if out else np.empty(0, np.int32)


def _columns(run: Run, truth: list[np.ndarray] | None) -> dict[str, np.ndarray]:
    frames = run.frames

    def steps(values: list[int]) -> np.ndarray:
        return np.diff(np.array(values, np.int64), prepend=0)

    xy = [_whole(f.xy, LENGTH_M) for f in frames]
    columns = {
        "t": steps([round(f.t / _TIME_S) for f in frames]),
        "trial": steps([f.trial for f in frames]), "model": steps([f.model for f in frames]),
        "push": steps([f.push for f in frames]), "stage": steps([f.stage for f in frames]),
        "n": steps([f.ids.size for f in frames]), "ids": _rows([f.ids for f in frames]),
        "x": _rows([a[:, 0] for a in xy]), "y": _rows([a[:, 1] for a in xy]),
        "motion": _rows([_motion(f) for f in frames]),
    }
    if truth is not None:
        columns["truth"] = _rows([
            _whole(t, np.array([LENGTH_M, LENGTH_M, ANGLE_RAD])).ravel() for t in truth])
    return columns


def pack(run: Run, title: str, *, live: bool = False, truth: Any = None,
         info: dict[str, Any] | None = None) -> bytes:
    """Everything the page shows.

    Parameters
    ----------
    run : Run
    title : str
        Of the log, or of the bus.
    live : bool
        Whether more will follow.
    truth : Truth, optional
        Of the simulator, to be laid over.
    info : dict, optional
        What is said about the bus.
    """
    columns = _columns(run, None if truth is None else truth.poses)
    header = {"title": title, "live": live, "frames": len(run.frames),
              "length_m": LENGTH_M, "angle_rad": ANGLE_RAD, "time_s": _TIME_S,
              "columns": [[name, int(values.size)] for name, values in columns.items()],
              "models": [model_json(m) for m in run.models],
              "pushes": [record_json(p) for p in run.pushes],
              "trials": [record_json(t) for t in run.trials],
              "info": info or {"warnings": run.warnings(), "stopped": run.stopped}}
    if truth is not None:
        header["truth"] = {"object": truth.object, "seed": truth.seed, "sizes": _round(truth.sizes),
                           "joints": truth.joints}
    text = json.dumps(header, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    return zlib.compress(struct.pack("<I", len(text)) + text
                         + b"".join(_planes(values) for values in columns.values()), 6)


def page(data: bytes | None = None, title: str = "grrl-view") -> str:
    """The page: with a run within it, to be mailed, or one that asks its server."""
    folder = importlib.resources.files(__package__)
    text = (folder / "page.html").read_text(encoding="utf-8")
    script = "\n".join((folder / name).read_text(encoding="utf-8")
                       for name in ("data.js", "draw.js", "page.js"))
    within = "" if data is None else base64.b64encode(data).decode()
    script = script.replace("@COLOURS@", json.dumps(COLOURS))
    safe = title.replace("&", "&amp;").replace("<", "&lt;")
    parts = {"TITLE": safe, "STYLE": (folder / "page.css").read_text(encoding="utf-8"),
             "SCRIPT": script, "DATA": within}
    return re.sub("@(TITLE|STYLE|SCRIPT|DATA)@", lambda mark: parts[mark[1]], text)
