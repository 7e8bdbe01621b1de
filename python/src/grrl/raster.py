"""A model as pixels, with NumPy alone: quick enough for every step of an environment."""

from __future__ import annotations

import numpy as np

from .model import BACKGROUND, Model
from .plot import colour_of

_HEIGHT, _WIDTH = 384, 480
_TABLE_M = (2.0, 1.6)  # as wide as the picture, and as high
_INK = (34, 34, 34)


def _rgb(colour: str) -> tuple[int, int, int]:
    return (int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16))


def _pixel(at: np.ndarray) -> np.ndarray:
    """Column and row of positions in metres; y points up."""
    scale = np.array([_WIDTH / _TABLE_M[0], -_HEIGHT / _TABLE_M[1]])
    return np.rint(np.asarray(at) * scale + [_WIDTH / 2, _HEIGHT / 2]).astype(int)


def _dots(picture: np.ndarray, at: np.ndarray, radius: int, colour: tuple[int, int, int]) -> None:
    reach = np.arange(-radius, radius + 1)
    dx, dy = (d.ravel() for d in np.meshgrid(reach, reach))
    disc = dx**2 + dy**2 <= radius**2
    places = _pixel(at).reshape(-1, 1, 2) + np.stack([dx[disc], dy[disc]], axis=1)
    x, y = places[..., 0].ravel(), places[..., 1].ravel()
    inside = (x >= 0) & (x < _WIDTH) & (y >= 0) & (y < _HEIGHT)
    picture[y[inside], x[inside]] = colour


def picture_of(model: Model) -> np.ndarray:
    """(384, 480, 3) uint8, the table centred on the origin; the model in metres."""
    picture = np.full((_HEIGHT, _WIDTH, 3), 255, np.uint8)
    _dots(picture, model.positions[model.body_of <= BACKGROUND], 1, (187, 187, 187))
    for joint in model.joints:
        if joint.axis is not None:
            reach = 0.6 * (model.bodies[joint.a].length + model.bodies[joint.b].length)
            dashes = np.linspace(-reach, reach, 25).reshape(-1, 1)
            _dots(picture, joint.point + dashes * joint.axis, 1, _INK)
    for i in range(len(model.bodies)):
        _dots(picture, model.positions[model.body_of == i], 2, _rgb(colour_of(i)))
    for joint in model.joints:
        if joint.axis is None:
            _dots(picture, joint.point, 4, _INK)
            _dots(picture, joint.point, 2, (255, 255, 255))
    return picture
