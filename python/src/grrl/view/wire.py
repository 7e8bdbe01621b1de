"""From the bytes of a message to a dictionary, with the checks that a viewer needs."""

from __future__ import annotations

import math
import re
import struct
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..io import _fingerprint

# The members of the messages that are shown; a test compares them with lcmtypes/*.lcm.
_MEMBERS = {
    "points_t": """
        int64_t utime; int64_t session_id; int64_t seq; int32_t trial_id; int32_t ack_cmd_seq;
        int64_t agent_session_id; int8_t mode; int8_t phase; int32_t n_points;
        int32_t id[n_points]; float x[n_points]; float y[n_points];""",
    "trial_t": """
        int64_t utime; int64_t session_id; int32_t trial_id; int32_t revision;
        int32_t judged_cmd_seq; int8_t phase; int8_t outcome;""",
    "model_t": """
        int64_t utime; int64_t session_id; int32_t trial_id; int32_t cmd_seq; int32_t n_links;
        int32_t n_joints; int32_t n_features; int16_t link_number[n_links]; float link_x[n_links];
        float link_y[n_links]; float link_angle[n_links]; float link_length[n_links];
        float link_width[n_links]; int8_t link_size[n_links]; int8_t joint_a[n_joints];
        int8_t joint_b[n_joints]; int8_t joint_type[n_joints]; float joint_probability[n_joints];
        float joint_x[n_joints]; float joint_y[n_joints]; float joint_angle[n_joints];
        float joint_lower[n_joints]; float joint_upper[n_joints]; int32_t feature_id[n_features];
        int8_t feature_link[n_features];""",
    "decision_t": """
        int64_t utime; int64_t session_id; int32_t trial_id; int32_t cmd_seq; int16_t link_number;
        int16_t direction_deg; int8_t reason; int8_t source; int16_t distance; int32_t source_index;
        float value; float lower; float upper; float phi; float last_reward; float last_target;""",
    "push_command_t": """
        int64_t utime; int64_t session_id; int64_t plant_session_id; int64_t points_seq;
        int32_t trial_id; int32_t trial_revision; int32_t cmd_seq; int8_t kind; float start[2];
        float end[2]; float travel; float speed; float force; float timeout;""",
    "push_status_t": """
        int64_t utime; int64_t session_id; int64_t agent_session_id; int32_t trial_id;
        int32_t cmd_seq; int8_t state; int8_t reason; float tool[2];""",
    "agent_status_t": """
        int64_t utime; int64_t session_id; int64_t plant_session_id; int32_t trial_id;
        int32_t pushes; int32_t entries; int32_t capacity; int32_t evictions; int64_t received;
        int64_t lost; int64_t repeated; int64_t rejected; int64_t foreign;""",
    "stop_t": """
        int64_t utime; int64_t session_id; int64_t agent_session_id; int8_t reason;""",
}
CHANNELS = {f"GRRL_{name[:-2].upper()}": name for name in _MEMBERS}

_CODES = {"int8_t": "i1", "int16_t": "i2", "int32_t": "i4", "int64_t": "i8", "float": "f4"}
_MAX = {"n_points": 256, "n_links": 32, "n_joints": 64, "n_features": 256}
_FAR_M = 1000.0
# Smallest and largest value of what selects something, as in lcmtypes/wire.c.
_RANGES = {
    "points_t": {"session_id": (1, 2**63), "seq": (1, 2**63), "trial_id": (0, 2**31),
                 "ack_cmd_seq": (0, 2**31), "mode": (0, 2), "phase": (0, 3), "x": (-_FAR_M, _FAR_M),
                 "y": (-_FAR_M, _FAR_M)},
    "trial_t": {"session_id": (1, 2**63), "trial_id": (1, 2**31), "phase": (0, 2), "outcome": (0, 3)},
    "model_t": {"session_id": (1, 2**63), "trial_id": (0, 2**31), "cmd_seq": (0, 2**31),
                "link_number": (0, 32767), "link_x": (-_FAR_M, _FAR_M), "link_y": (-_FAR_M, _FAR_M),
                "link_length": (0, _FAR_M), "link_width": (0, _FAR_M), "joint_type": (0, 1),
                "joint_probability": (0, 1), "joint_a": (0, 31), "joint_b": (0, 31),
                "feature_link": (-2, 31)},
    "decision_t": {"session_id": (1, 2**63), "trial_id": (0, 2**31), "cmd_seq": (1, 2**31),
                   "link_number": (0, 32767), "direction_deg": (0, 359), "reason": (0, 4),
                   "source": (0, 4), "phi": (0, 1)},
    "push_command_t": {"session_id": (1, 2**63), "trial_id": (0, 2**31), "cmd_seq": (0, 2**31),
                       "kind": (0, 1), "start": (-_FAR_M, _FAR_M), "end": (-_FAR_M, _FAR_M)},
    "push_status_t": {"session_id": (1, 2**63), "trial_id": (0, 2**31), "cmd_seq": (0, 2**31),
                      "state": (0, 3), "reason": (0, 5), "tool": (-_FAR_M, _FAR_M)},
    "agent_status_t": {"session_id": (1, 2**63)},
    "stop_t": {"session_id": (1, 2**63), "reason": (0, 3)},
}


class OtherSchema(ValueError):
    """The fingerprint is another one: no such message, or one of another version of grrl."""


@dataclass(frozen=True)
class _Type:
    """members: (name, type, count), the count "" of a single value; head: how many of them precede
    the first array of variable length."""

    name: str
    members: tuple[tuple[str, str, str], ...]
    fingerprint: int
    head: struct.Struct
    head_members: tuple[tuple[str, int], ...]
    arrays: tuple[tuple[str, np.dtype[Any], str], ...]
    ranges: dict[str, tuple[float, float]] = field(default_factory=dict)


def members_of(text: str) -> tuple[tuple[str, str, str], ...]:
    """(name, type, count) of each member of a struct of an .lcm file, without its constants."""
    found = re.findall(r"^\s*(\w+)\s+(\w+)(?:\[(\w+)\])?\s*$", text.replace(";", "\n"), re.MULTILINE)
    return tuple((name, kind, count) for kind, name, count in found)


def _type(name: str, text: str) -> _Type:
    members = members_of(text)
    code, head, arrays = ">Q", [], []
    for member, kind, count in members:
        if count and not count.isdigit():
            arrays.append((member, np.dtype(">" + _CODES[kind]), count))
        else:
            n = int(count or 1)
            code += f"{n}{np.dtype(_CODES[kind]).char if kind != 'int64_t' else 'q'}"
            head.append((member, n))
    return _Type(name, members, _fingerprint(members), struct.Struct(code), tuple(head),
                 tuple(arrays), _RANGES[name])


TYPES = {name: _type(name, text) for name, text in _MEMBERS.items()}


def _check(kind: _Type, message: dict[str, Any]) -> None:
    for name, (low, high) in kind.ranges.items():
        value = message[name]
        if isinstance(value, np.ndarray):  # NaN fails, too
            good = value.size == 0 or (value.min() >= low and value.max() <= high)
        elif isinstance(value, tuple):
            good = all(low <= v <= high for v in value)
        else:
            good = low <= value <= high
        if not good:
            raise ValueError(f"{kind.name}: {name} must be {low} to {high}")
    if kind.name != "model_t":
        return
    n = message["n_links"]
    if (np.any(message["joint_a"] >= n) or np.any(message["joint_b"] >= n)
            or np.any(message["joint_a"] == message["joint_b"]) or np.any(message["feature_link"] >= n)):
        raise ValueError("model_t: a link that is not there")
    if not all(np.all(np.isfinite(message[name])) for name in
               ("link_angle", "joint_x", "joint_y", "joint_angle", "joint_lower", "joint_upper")):
        raise ValueError("model_t: a number that is not finite")


def decode(name: str, data: bytes) -> dict[str, Any]:
    """A message of the type `name`: numbers, tuples of a fixed and arrays of a variable length.

    Raises
    ------
    OtherSchema
        Its fingerprint is not this type's.
    ValueError
        What is wrong with it.
    """
    kind = TYPES[name]
    if len(data) < 8 or int.from_bytes(data[:8], "big") != kind.fingerprint:
        raise OtherSchema(f"not a {name}, or one of another version")
    if len(data) < kind.head.size:
        raise ValueError(f"{name}: ends after {len(data)} bytes")
    values = kind.head.unpack_from(data)
    message: dict[str, Any] = {}
    at = 1
    for member, n in kind.head_members:
        message[member] = values[at] if n == 1 else values[at:at + n]
        at += n
    at = kind.head.size
    for member, dtype, counter in kind.arrays:
        n = message[counter]
        if not 0 <= n <= _MAX[counter]:
            raise ValueError(f"{name}: {counter} is {n}, must be 0 to {_MAX[counter]}")
        if at + n * dtype.itemsize > len(data):
            raise ValueError(f"{name}: ends within {member}, after {len(data)} bytes")
        message[member] = np.frombuffer(data, dtype, n, at).astype(dtype.newbyteorder("="))
        at += n * dtype.itemsize
    if at != len(data):
        raise ValueError(f"{name}: {len(data) - at} bytes too many")
    if not all(math.isfinite(v) for v in values[1:] if isinstance(v, float)):
        raise ValueError(f"{name}: a number that is not finite")
    _check(kind, message)
    return message
