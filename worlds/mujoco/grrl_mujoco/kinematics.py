"""Planar poses of links from joint values, and joint values that close loops.

A pose is (x, y, angle). A spanning forest of the joints carries the poses; each further joint
closes a loop and is brought together by least squares.
"""

import math
from dataclasses import dataclass

import numpy as np

ANGLE_LEVER_M = 0.1  # turns angle errors into lengths
CLOSED_M = 1e-7


def rotate(v, angle):
    c, s = math.cos(angle), math.sin(angle)
    return (c * v[0] - s * v[1], s * v[0] + c * v[1])


def transform(pose, v):
    x, y = rotate(v, pose[2])
    return (pose[0] + x, pose[1] + y)


def compose(outer, inner):
    x, y = transform(outer, inner)
    return (x, y, outer[2] + inner[2])


def inverse(pose):
    x, y = rotate((-pose[0], -pose[1]), -pose[2])
    return (x, y, -pose[2])


def wrap(angle):
    return angle - 2 * math.pi * math.ceil(angle / (2 * math.pi) - 0.5)


def relative_pose(joint, value):
    """Link b in the frame of link a."""
    turn = joint.angle + (value if joint.kind == "R" else 0.0)
    slide = value if joint.kind == "P" else 0.0
    back = rotate(joint.anchor_b, turn)
    return (
        joint.anchor_a[0] + slide * math.cos(joint.axis) - back[0],
        joint.anchor_a[1] + slide * math.sin(joint.axis) - back[1],
        turn,
    )


def joint_value(joint, a, b):
    """Of a joint between links at these poses."""
    relative = compose(inverse(a), b)
    if joint.kind == "R":
        return wrap(relative[2] - joint.angle)
    x, y = transform(relative, joint.anchor_b)
    gap = (x - joint.anchor_a[0], y - joint.anchor_a[1])
    return gap[0] * math.cos(joint.axis) + gap[1] * math.sin(joint.axis)


@dataclass
class Forest:
    tree: list  # (joint, from_a): in an order in which one of its links is placed already
    closing: list  # the other joints
    roots: list  # one link of each component, the fixed one if there is one
    component: list  # of each link


def spanning_forest(links, joints):
    component = [-1] * len(links)
    roots, tree, used = [], [], set()
    for root in sorted(range(len(links)), key=lambda i: not links[i].fixed):
        if component[root] >= 0:
            continue
        component[root] = len(roots)
        roots.append(root)
        grown = True
        while grown:
            grown = False
            for j, joint in enumerate(joints):
                has_a = component[joint.a] == component[root]
                has_b = component[joint.b] == component[root]
                if j in used or has_a == has_b:
                    continue
                component[joint.b if has_a else joint.a] = component[root]
                tree.append((j, has_a))
                used.add(j)
                grown = True
    closing = [j for j in range(len(joints)) if j not in used]
    return Forest(tree, closing, roots, component)


def link_poses(links, joints, forest, values):
    """Roots at the origin."""
    poses = [(0.0, 0.0, 0.0)] * len(links)
    for j, from_a in forest.tree:
        joint, relative = joints[j], relative_pose(joints[j], values[j])
        if from_a:
            poses[joint.b] = compose(poses[joint.a], relative)
        else:
            poses[joint.a] = compose(poses[joint.b], inverse(relative))
    return poses


def _closing_errors(links, joints, forest, values):
    poses = link_poses(links, joints, forest, values)
    errors = []
    for j in forest.closing:
        joint = joints[j]
        relative = compose(inverse(poses[joint.a]), poses[joint.b])
        x, y = transform(relative, joint.anchor_b)
        gap = (x - joint.anchor_a[0], y - joint.anchor_a[1])
        if joint.kind == "R":
            errors += gap
        else:
            across = math.cos(joint.axis) * gap[1] - math.sin(joint.axis) * gap[0]
            errors += [across, ANGLE_LEVER_M * wrap(relative[2] - joint.angle)]
    return np.array(errors)


def close_loops(links, joints, forest, values):
    """The nearest values that close every loop (Levenberg-Marquardt), or None."""
    values = list(values)
    if not forest.closing:
        return values
    free = [j for j, _ in forest.tree]
    damping = 1e-3
    errors = _closing_errors(links, joints, forest, values)
    for _ in range(200):
        if np.max(np.abs(errors)) < CLOSED_M:
            break
        jacobian = np.empty((len(errors), len(free)))
        for column, j in enumerate(free):
            moved = list(values)
            moved[j] += 1e-6
            jacobian[:, column] = (_closing_errors(links, joints, forest, moved) - errors) / 1e-6
        normal = jacobian.T @ jacobian + damping * np.eye(len(free))
        step = -np.linalg.solve(normal, jacobian.T @ errors)
        trial = list(values)
        for column, j in enumerate(free):
            trial[j] += float(step[column])
        trial_errors = _closing_errors(links, joints, forest, trial)
        if trial_errors @ trial_errors < errors @ errors:
            values, errors, damping = trial, trial_errors, damping / 4
        else:
            damping *= 4
    else:
        return None
    poses = link_poses(links, joints, forest, values)
    for j in forest.closing:
        values[j] = joint_value(joints[j], poses[joints[j].a], poses[joints[j].b])
    return values


def movable_joints(links, joints, forest, values):
    """For each joint, whether it can move at first order while all loops stay closed."""
    if not forest.closing:
        return [True] * len(joints)
    free = [j for j, _ in forest.tree]

    def column(j, function):
        moved = [list(values), list(values)]
        moved[0][j] += 1e-6
        moved[1][j] -= 1e-6
        return (function(moved[0]) - function(moved[1])) / 2e-6

    def errors(at):
        return _closing_errors(links, joints, forest, at)

    def closing_values(at):
        poses = link_poses(links, joints, forest, at)
        return np.array([joint_value(joints[j], poses[joints[j].a], poses[joints[j].b])
                         for j in forest.closing])

    jacobian = np.array([column(j, errors) for j in free]).T
    _, sizes, rows = np.linalg.svd(jacobian)
    rank = int((sizes > 1e-6 * sizes[0]).sum())
    motions = rows[rank:]
    movable = [False] * len(joints)
    if len(motions):
        further = motions @ np.array([column(j, closing_values) for j in free])
        for order, rates in ((free, motions), (forest.closing, further)):
            for k, j in enumerate(order):
                movable[j] = bool(np.abs(rates[:, k]).max() > 1e-6)
    return movable


def corners(link, pose):
    x, y = link.length / 2, link.width / 2
    return np.array([transform(pose, (sx * x, sy * y)) for sx in (-1, 1) for sy in (-1, 1)])


def rectangles_overlap(link_a, pose_a, link_b, pose_b, margin):
    """Whether the outlines come nearer than the margin along every axis of either (exact at 0)."""
    a, b = corners(link_a, pose_a), corners(link_b, pose_b)
    for angle in (pose_a[2], pose_b[2]):
        for turn in (0.0, math.pi / 2):
            axis = np.array([math.cos(angle + turn), math.sin(angle + turn)])
            p, q = a @ axis, b @ axis
            if p.max() + margin < q.min() or q.max() + margin < p.min():
                return False
    return True


def distance_to_link(link, pose, point):
    """From a point to the outline of a link as a rectangle; 0 within it."""
    x, y = transform(inverse(pose), point)
    return math.hypot(max(abs(x) - link.length / 2, 0.0), max(abs(y) - link.width / 2, 0.0))
