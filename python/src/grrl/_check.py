"""What comes from outside, checked before it reaches the extension module."""

from __future__ import annotations

import math
import operator
from typing import Any

import numpy as np

UNITS = ("px", "mm", "m")
PROFILES = ("tracker", "camera")
METRES = {"px": 0.001, "mm": 0.001, "m": 1.0}
INT32 = (-(2**31), 2**31 - 1)


def numbers(value: Any, name: str) -> np.ndarray:
    """An array of real numbers; masked values become NaN."""
    if isinstance(value, np.ma.MaskedArray):
        value = np.ma.filled(value.astype(np.float64), np.nan)
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise ValueError(f"{name} must be a regular array: {error}") from None
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} must hold real numbers (float or int), but its dtype is {array.dtype}")
    return array


def positions(value: Any, name: str, shape: str, ndim: int) -> np.ndarray:
    """(.., 2) float32 without infinities; both coordinates of a point are NaN, or none."""
    array = numbers(value, name)
    if array.ndim != ndim or array.shape[-1] != 2:
        raise ValueError(f"{name} must have the shape {shape}, but it has {array.shape}")
    if 0 in array.shape:
        raise ValueError(f"{name} is empty: its shape is {array.shape}")
    with np.errstate(over="ignore"):
        single = np.ascontiguousarray(array, dtype=np.float32)
    infinite = np.argwhere(np.isinf(single))
    if infinite.size:
        place = tuple(int(i) for i in infinite[0])
        raise ValueError(f"{name}{list(place)} is {array[place]:g}: a position must be a finite number "
                         "of single precision, or NaN for a point that was not seen")
    missing = np.isnan(single)
    half = np.argwhere(missing[..., 0] != missing[..., 1])
    if half.size:
        raise ValueError(f"{name}{[int(i) for i in half[0]]} has only one coordinate; both are NaN for "
                         "a point that was not seen")
    return single


def integers(value: Any, name: str, low: int, high: int) -> np.ndarray:
    """A one-dimensional array of whole numbers within a range, as int64."""
    array = numbers(value, name)
    if array.ndim != 1:
        raise ValueError(f"{name} must have one dimension, but its shape is {array.shape}")
    if array.dtype.kind == "f":
        if not np.all(np.isfinite(array)) or np.any(array != np.floor(array)):
            raise ValueError(f"{name} must hold whole numbers")
    if array.size and not (low <= array.min() and array.max() <= high):
        raise ValueError(f"{name} must be within {low} to {high}")
    return array.astype(np.int64)


def flags(value: Any, name: str, n: int) -> np.ndarray:
    """(n,) bool."""
    array = np.asarray(value)
    if array.dtype != np.bool_ or array.shape != (n,):
        raise ValueError(f"{name} must be {n} booleans, but it is {array.dtype} of shape {array.shape}")
    return np.ascontiguousarray(array)


def whole(value: Any, name: str, low: int, high: int) -> int:
    """A whole number within a range; no bool, no float."""
    if isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} must be a whole number, not a bool")
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be a whole number, not {type(value).__name__}") from None
    if not low <= number <= high:
        raise ValueError(f"{name} is {number}, but must be from {low} to {high}")
    return number


def real(value: Any, name: str, low: float, high: float) -> float:
    """A finite number within a range."""
    if isinstance(value, (bool, np.bool_, str, bytes)):
        raise TypeError(f"{name} must be a number, not {type(value).__name__}")
    try:
        number = float(value)
    except (TypeError, OverflowError):
        raise TypeError(f"{name} must be a number, not {type(value).__name__}") from None
    if not (math.isfinite(number) and low <= number <= high):
        raise ValueError(f"{name} is {number:g}, but must be from {low:g} to {high:g}")
    return number


def one_of(value: Any, name: str, choices: tuple[str, ...]) -> str:
    if not isinstance(value, str) or value not in choices:
        raise ValueError(f"{name} must be one of {', '.join(map(repr, choices))}, not {value!r}")
    return value


def places(value: Any, name: str) -> list[float]:
    """Four rows of four finite numbers, one after the other."""
    array = numbers(value, name).astype(np.float64)
    if array.shape != (4, 4) or not np.all(np.isfinite(array)):
        raise ValueError(f"{name} must be four rows (pixel x, pixel y, table x, table y) of finite "
                         f"numbers; its shape is {array.shape}")
    return [float(number) for number in array.ravel()]


def unit_and_profile(unit: str, profile: str | None) -> tuple[str, str]:
    """The profile, by default that of the unit; the camera's is for pixels only."""
    unit = one_of(unit, "unit", UNITS)
    if profile is None:
        profile = "camera" if unit == "px" else "tracker"
    profile = one_of(profile, "profile", PROFILES)
    if profile == "camera" and unit != "px":
        raise ValueError(f"the profile 'camera' is for unit='px', not {unit!r}")
    return unit, profile
