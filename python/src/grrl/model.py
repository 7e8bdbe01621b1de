"""What perception believes: bodies, joints and open pairs."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TYPES = ("revolute", "prismatic")
BACKGROUND = -1
UNASSIGNED = -2
_RELATIONS = ("undetermined", "disconnected")
_NO_JOINT = "their motion shows no joint, with a probability of 0.95 and more"


@dataclass(frozen=True, eq=False)
class Body:
    """A link: points that move as one rigid body.

    Attributes
    ----------
    name : str
        "f1": stays with the body; as the term has it.
    number : int
        1 for "f1".
    points : (n,) int32
        The ids of its points.
    centroid : (2,) float64
        Of its points, now; in the unit of the model.
    axis : (2,) float64
        Unit vector along its principal axis, without a meaningful sign.
    length, width : float
        Extent of its points along the axis and across; in the unit of the model.
    frame : (2, 2) float64
        Unit vectors of the directions 0 and 90 degrees of a push at this body.
    """

    name: str
    number: int
    points: np.ndarray
    centroid: np.ndarray
    axis: np.ndarray
    length: float
    width: float
    frame: np.ndarray


@dataclass(frozen=True, eq=False)
class Joint:
    """A joint between two bodies, as it lies now.

    Attributes
    ----------
    a, b : int
        Indices into `Model.bodies`, a < b.
    type : {"revolute", "prismatic"}
    probability : float
        Of this type, given the evidence.
    p_revolute, p_prismatic, p_disconnected : float
        Of each possibility; their sum is 1.
    point : (2,) float64
        The pivot, or a point on the sliding axis; in the unit of the model.
    covariance : (2, 2) float64
        Of the point, for a prismatic joint across the axis; in the unit squared.
    axis : (2,) float64 or None
        Unit vector of sliding; None for a revolute joint.
    axis_sd : float
        Standard deviation of the axis' direction, radians.
    lower, upper : float
        Smallest and largest excursion seen, from the first keyframe: radians of b relative to a, or
        the unit of the model along the axis.
    motion : (frames,) float64 or None
        Angle (radians) or travel (unit) in each frame, 0 in the first where it is known; NaN where
        fewer than two points of a body are seen. None: not asked for, or not of a whole recording.
    """

    a: int
    b: int
    type: str
    probability: float
    p_revolute: float
    p_prismatic: float
    p_disconnected: float
    point: np.ndarray
    covariance: np.ndarray
    axis: np.ndarray | None
    axis_sd: float
    lower: float
    upper: float
    motion: np.ndarray | None = None


@dataclass(frozen=True)
class Pair:
    """Two bodies that no joint ties, and why.

    Attributes
    ----------
    a, b : int
        Indices into `Model.bodies`.
    relation : {"undetermined", "disconnected"}
    why : str
        In words; of an undetermined pair those of `grrl-perceive`.
    p_revolute, p_prismatic, p_disconnected : float
        By the motion of the two alone; a third each: it does not tell.
    """

    a: int
    b: int
    relation: str
    why: str
    p_revolute: float
    p_prismatic: float
    p_disconnected: float


@dataclass(frozen=True, eq=False)
class Model:
    """Everything perception believes.

    Attributes
    ----------
    term : str
        The structure, such as "D(lb, R(L(s, f1), L(s, f2)))".
    unit : {"px", "mm", "m"}
        Of all lengths here.
    bodies, joints, pairs : tuple
        In order of discovery; pairs are those that no joint ties.
    ids : (n,) int32
        The points.
    positions : (n, 2) float64
        Where each is now, or was last seen; in `unit`.
    body_of : (n,) int32
        Index into `bodies`; -1 background, -2 nothing known.
    frames : (frames,) int64 or None
        The numbers of the recording's frames, for `Joint.motion`.
    profile : str
    noise : float
        Standard deviation of a point, per axis; in `unit`.
    counts : dict
        Frames, keyframes, points left out and why.
    warnings : tuple of str
        What makes the answer doubtful.
    """

    term: str
    unit: str
    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    pairs: tuple[Pair, ...]
    ids: np.ndarray
    positions: np.ndarray
    body_of: np.ndarray
    frames: np.ndarray | None = None
    profile: str = "tracker"
    noise: float = float("nan")
    counts: dict[str, int] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @cached_property
    def background(self) -> np.ndarray:
        """(n,) int32: points that lie still and are no body's."""
        return self.ids[self.body_of == BACKGROUND]

    @cached_property
    def unassigned(self) -> np.ndarray:
        """(n,) int32: points of which nothing is known."""
        return self.ids[self.body_of == UNASSIGNED]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draws points by body, pivots with two standard deviations, and axes; needs matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; a new figure by default.
        """
        from .plot import plot_model

        return plot_model(self, ax)

    def __str__(self) -> str:
        lines = [self.term]
        for joint in self.joints:
            a, b = self.bodies[joint.a].name, self.bodies[joint.b].name
            where = "through" if joint.type == "prismatic" else "pivot"
            lines.append(f"  {a} {b} {joint.type} {joint.probability:.3f}, {where} "
                         f"({joint.point[0]:.4g}, {joint.point[1]:.4g}) {self.unit}")
        for pair in self.pairs:
            lines.append(f"  {self.bodies[pair.a].name} {self.bodies[pair.b].name} {pair.relation}: "
                         f"{pair.why}")
        return "\n".join(lines)

    def __repr__(self) -> str:
        return f"Model({self.term!r})"


def _bodies(raw: dict[str, Any]) -> tuple[Body, ...]:
    return tuple(
        Body(f"f{number}", int(number), raw["feature_id"][raw["feature_body"] == i], centroid, axis,
             float(size[0]), float(size[1]), frame)
        for i, (number, centroid, axis, size, frame) in enumerate(
            zip(raw["body_number"], raw["body_centroid"], raw["body_axis"], raw["body_size"],
                raw["body_frame"])))


def _joints(raw: dict[str, Any]) -> tuple[Joint, ...]:
    joints = []
    motion = raw.get("motion")
    for i, (a, b) in enumerate(raw["joint_ends"]):
        kind = TYPES[raw["joint_type"][i]]
        p = [float(x) for x in raw["joint_p"][i]]
        lower, upper = raw["joint_range"][i]
        joints.append(Joint(
            int(a), int(b), kind, probability=p[0], p_revolute=p[1], p_prismatic=p[2],
            p_disconnected=p[3], point=raw["joint_point"][i], covariance=raw["joint_covariance"][i],
            axis=raw["joint_axis"][i] if kind == "prismatic" else None,
            axis_sd=float(raw["joint_axis_sd"][i]), lower=float(lower), upper=float(upper),
            motion=None if motion is None else motion[i]))
    return tuple(joints)


def _pairs(raw: dict[str, Any]) -> tuple[Pair, ...]:
    return tuple(
        Pair(int(a), int(b), _RELATIONS[relation], reason or _NO_JOINT, *(float(x) for x in p))
        for (a, b), relation, reason, p in zip(raw["pair_ends"], raw["pair_relation"],
                                               raw["pair_reason"], raw["pair_p"]))


def model_from(raw: dict[str, Any], unit: str, **rest: Any) -> Model:
    """The model of what the extension module returns."""
    return Model(raw["term"], unit, _bodies(raw), _joints(raw), _pairs(raw), raw["feature_id"],
                 raw["feature_at"], raw["feature_body"], **rest)
