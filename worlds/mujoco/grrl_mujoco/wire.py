"""Messages of the agent, checked before use; lcmtypes/wire.c has the ranges."""

import math
import struct

import grrl

CHANNEL_POINTS = "GRRL_POINTS"
CHANNEL_TRIAL = "GRRL_TRIAL"
CHANNEL_PUSH_STATUS = "GRRL_PUSH_STATUS"
CHANNEL_PUSH_COMMAND = "GRRL_PUSH_COMMAND"
CHANNEL_MODEL = "GRRL_MODEL"
CHANNEL_DECISION = "GRRL_DECISION"
CHANNEL_AGENT_STATUS = "GRRL_AGENT_STATUS"

MAX_BYTES = 4096
MAX_LINKS = 32
MAX_JOINTS = 64
MAX_POINTS = 256

_COUNT = (0, 2**63 - 1)
_COORDINATE = (-1000, 1000)
_RANGES = {
    grrl.push_command_t: {
        "session_id": (1, 2**63 - 1), "plant_session_id": _COUNT, "points_seq": _COUNT,
        "trial_id": _COUNT, "trial_revision": _COUNT, "cmd_seq": _COUNT, "kind": (0, 1),
        "start": _COORDINATE, "end": _COORDINATE, "travel": (0, 1000), "speed": (0, 100),
        "force": (0, 10000), "timeout": (0, 3600),
    },
    grrl.model_t: {
        "session_id": (1, 2**63 - 1), "trial_id": _COUNT, "cmd_seq": _COUNT,
        "n_links": (0, MAX_LINKS), "n_joints": (0, MAX_JOINTS), "n_features": (0, MAX_POINTS),
        "joint_a": (0, MAX_LINKS - 1), "joint_b": (0, MAX_LINKS - 1), "joint_type": (0, 1),
        "joint_probability": (0, 1),
    },
    grrl.agent_status_t: {"session_id": (1, 2**63 - 1), "plant_session_id": _COUNT},
}


class WireError(ValueError):
    """Which message was refused, and why."""


def decode(kind, data):
    """A message of one of the types above with every number in its range, or WireError."""
    name = kind.__name__
    if len(data) > MAX_BYTES:
        raise WireError(f"{name}: {len(data)} bytes, at most {MAX_BYTES} are possible")
    try:
        message = kind.decode(data)
    except (ValueError, struct.error, MemoryError, OverflowError):
        raise WireError(f"{name}: not a message of this type, or cut off") from None
    for field, (least, most) in _RANGES[kind].items():
        value = getattr(message, field)
        for number in value if isinstance(value, (list, tuple)) else (value,):
            if not (math.isfinite(number) and least <= number <= most):
                raise WireError(f"{name}: {field} is {number:g}, must be {least:g} to {most:g}")
    if kind is grrl.model_t and any(
            i >= message.n_links for i in [*message.joint_a, *message.joint_b]):
        raise WireError(f"{name}: a joint refers to a link that does not exist")
    if len(message.encode()) != len(data):
        raise WireError(f"{name}: {len(data)} bytes are too many")
    return message
