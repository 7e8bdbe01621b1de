"""A model as a picture, in the style of `grrl-perceive --svg`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .model import BACKGROUND, Joint, Model

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Wong's palette for colour-blind readers, its yellow darkened, and three more.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a5195", "#8c564b",
           "#b5a300", "#17807e")
_INK = "#222222"


def colour_of(body: int) -> str:
    return COLOURS[body % len(COLOURS)]


def _draw_pivot(ax: Axes, joint: Joint) -> None:
    from matplotlib.patches import Ellipse

    variances, vectors = np.linalg.eigh(joint.covariance)
    sides = 2 * 2 * np.sqrt(np.maximum(variances, 0.0))  # two standard deviations each way
    angle = np.degrees(np.arctan2(vectors[1, 1], vectors[0, 1]))
    ax.add_patch(Ellipse(tuple(joint.point), sides[1], sides[0], angle=angle, facecolor="#0000001f",
                         edgecolor=_INK))
    ax.plot(*joint.point, "+", color=_INK, markersize=11, markeredgewidth=2)


def _draw_axis(ax: Axes, model: Model, joint: Joint) -> None:
    reach = 0.6 * (model.bodies[joint.a].length + model.bodies[joint.b].length)
    ends = joint.point + reach * np.outer([-1, 1], np.asarray(joint.axis))
    ax.plot(ends[:, 0], ends[:, 1], "--", color=_INK, linewidth=2)


def plot_model(model: Model, ax: Axes | None = None) -> Axes:
    """Draws a model; see `Model.plot`."""
    try:
        import matplotlib.pyplot as plt
    except ImportError:
        raise ImportError("plot() needs matplotlib: pip install 'grrl[plot]'") from None
    if ax is None:
        _, ax = plt.subplots(figsize=(9, 6), layout="constrained")
        beside = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)}
    else:
        beside = {"loc": "best"}
    for i, body in enumerate(model.bodies):
        at = model.positions[model.body_of == i]
        ax.scatter(at[:, 0], at[:, 1], s=36, color=colour_of(i), edgecolors="white",
                   label=f"{body.name}: {len(at)} features")
        ax.annotate(body.name, (body.centroid[0], body.centroid[1]), xytext=(8, 8),
                    textcoords="offset points", color=colour_of(i), weight="bold")
    still = model.positions[model.body_of == BACKGROUND]
    loose = model.positions[model.body_of < BACKGROUND]
    ax.scatter(still[:, 0], still[:, 1], s=20, color="#bbbbbb")
    ax.scatter(loose[:, 0], loose[:, 1], s=20, facecolors="none", edgecolors="#888888")
    for joint in model.joints:
        if joint.type == "revolute":
            _draw_pivot(ax, joint)
        else:
            _draw_axis(ax, model, joint)
        ends = f"{model.bodies[joint.a].name} – {model.bodies[joint.b].name}"
        ax.plot([], [], " ", label=f"{ends}: {joint.type} {joint.probability:.3f}")
    ax.set_aspect("equal")
    if model.unit == "px" and not ax.yaxis_inverted():
        ax.invert_yaxis()
    ax.set_xlabel(f"x ({model.unit})")
    ax.set_ylabel(f"y ({model.unit})")
    ax.set_title(model.term, fontsize="small", family="monospace", wrap=True)
    if model.bodies:
        ax.legend(fontsize="small", **beside)
    return ax
