"""An object as a MuJoCo model: links on four feet, joints with limits and dry friction, a finger.

A joint that would close a loop hangs a massless twin of its second link on the first one; a weld
holds twin and link together. So every joint, on a loop or not, has limits and friction.
"""

import math
import xml.etree.ElementTree as xml

from . import kinematics

FINGER_RADIUS_M = 0.01
FINGER_MASS_KG = 0.3
FINGER_GAIN = 1500.0  # N s/m: how strongly the guide holds its speed, up to the force limit
FOOT_RADIUS_M = 0.003
STEP_S = 1 / 480
STEPS_PER_FRAME = 16
LIFTED_M = 10.0  # above the camera

# Collision bits: feet with the table, bodies with bodies and with the finger.
_TABLE, _BODY, _FINGER = 1, 2, 4


def _text(*values):
    return " ".join(f"{value:.9g}" for value in values)


def _add(parent, tag, **attributes):
    return xml.SubElement(parent, tag, {k: str(v) for k, v in attributes.items()})


def _shape(body, link):
    """The bar above its feet; its density shares the mass among the geoms."""
    x, y = link.length / 2, link.width / 2
    low = 2 * FOOT_RADIUS_M
    z, half = low + link.height / 2, link.height / 2
    common = {"class": "body", "mass": link.mass}
    if link.shape == "capsule":
        _add(body, "geom", type="capsule", size=_text(y, x - y), pos=_text(0, 0, z),
             quat=_text(math.sqrt(0.5), 0, math.sqrt(0.5), 0), **common)
    elif link.shape == "rounded":
        for share, attributes in (
            (0.8, {"type": "box", "size": _text(x - y, y, half), "pos": _text(0, 0, z)}),
            (0.1, {"type": "cylinder", "size": _text(y, half), "pos": _text(x - y, 0, z)}),
            (0.1, {"type": "cylinder", "size": _text(y, half), "pos": _text(y - x, 0, z)}),
        ):
            _add(body, "geom", **{**common, "mass": link.mass * share}, **attributes)
    else:
        _add(body, "geom", type="box", size=_text(x, y, half), pos=_text(0, 0, z), **common)
    for sx in (-0.7, 0.7):
        for sy in (-0.7, 0.7):
            _add(body, "geom", **{"class": "foot"}, pos=_text(sx * x, sy * y, FOOT_RADIUS_M))


def _joint(body, joint, j, child_is_b):
    sign = 1 if child_is_b else -1
    at = joint.anchor_b if child_is_b else joint.anchor_a
    common = {"name": f"j{j}", "range": _text(joint.lower, joint.upper),
              "frictionloss": _text(joint.friction)}
    if joint.kind == "R":
        _add(body, "joint", type="hinge", axis=_text(0, 0, sign), pos=_text(*at, 0), **common)
        return
    angle = joint.axis - (joint.angle if child_is_b else 0.0)
    _add(body, "joint", type="slide", pos=_text(*at, 0),
         axis=_text(sign * math.cos(angle), sign * math.sin(angle), 0), **common)


def _frame(pose):
    return {"pos": _text(pose[0], pose[1], 0),
            "quat": _text(math.cos(pose[2] / 2), 0, 0, math.sin(pose[2] / 2))}


def scene_xml(obj, poses):
    """The model with the object at these poses, which are qpos0 of free and fixed roots.

    Joints start at 0 in qpos0; World sets their values.
    """
    root = xml.Element("mujoco", model="grrl")
    _add(root, "compiler", angle="radian", autolimits="true")
    option = _add(root, "option", timestep=_text(STEP_S), integrator="implicitfast",
                  cone="elliptic", impratio="20", noslip_iterations="4")
    _add(option, "flag", multiccd="enable")
    visual = _add(root, "visual")
    _add(visual, "global", offwidth="1280", offheight="1024")
    _add(visual, "headlight", ambient="0.3 0.3 0.3", diffuse="0.2 0.2 0.2", specular="0 0 0")
    default = _add(root, "default")
    for name, attributes in (
        ("body", {"contype": _BODY, "conaffinity": _BODY | _FINGER,
                  "friction": "0.3 0.001 0.0001"}),
        ("foot", {"type": "sphere", "size": _text(FOOT_RADIUS_M), "contype": 0,
                  "conaffinity": _TABLE, "mass": 1e-5, "priority": 1,
                  "friction": _text(obj.table_friction, 0.001, 0.0001)}),
    ):
        _add(_add(default, "default", **{"class": name}), "geom", **attributes)
    _add(default, "joint", limited="true", armature="1e-5")
    world = _add(root, "worldbody")
    _add(world, "light", pos="0.5 -0.6 3", dir="-0.15 0.2 -1", diffuse="0.4 0.4 0.4",
         specular="0.1 0.1 0.1")
    _add(world, "camera", name="above", pos="0 0 2.6", fovy="38")
    _add(world, "geom", name="table", type="plane", contype=_TABLE, conaffinity=0,
         size="0 0 0.05", rgba="0.6 0.57 0.5 1")
    finger = _add(world, "body", name="finger", pos=_text(0, 0, LIFTED_M))
    _add(finger, "joint", name="guide", type="slide", axis="1 0 0", limited="false")
    _add(finger, "geom", name="finger", type="capsule", fromto=_text(0, 0, 0, 0, 0, 0.1),
         size=_text(FINGER_RADIUS_M), mass=FINGER_MASS_KG, contype=_FINGER, conaffinity=0,
         priority=2, friction=_text(obj.finger_friction, 0.001, 0.0001), rgba="0.2 0.2 0.25 1")
    contact, equality = _add(root, "contact"), _add(root, "equality")
    _add_links(world, contact, equality, obj, poses)
    actuator = _add(root, "actuator")
    _add(actuator, "velocity", name="finger", joint="guide", kv=_text(FINGER_GAIN),
         forcerange="-10 10")
    return xml.tostring(root, encoding="unicode")


def _add_links(world, contact, equality, obj, poses):
    forest = kinematics.spanning_forest(obj.links, obj.joints)
    colours = ("0.85 0.45 0.25 1", "0.3 0.55 0.75 1", "0.45 0.65 0.35 1", "0.7 0.45 0.65 1")
    bodies = {}

    def add_body(parent, i, pose):
        bodies[i] = _add(parent, "body", name=f"l{i}", **_frame(pose))

    for i in forest.roots:
        add_body(world, i, poses[i])
        if not obj.links[i].fixed:
            _add(bodies[i], "freejoint", name=f"free{i}")
    for j, from_a in forest.tree:
        joint = obj.joints[j]
        relative = kinematics.relative_pose(joint, 0.0)
        parent, child = (joint.a, joint.b) if from_a else (joint.b, joint.a)
        add_body(bodies[parent], child, relative if from_a else kinematics.inverse(relative))
        _joint(bodies[child], joint, j, from_a)
    for j in forest.closing:
        joint = obj.joints[j]
        twin = _add(bodies[joint.a], "body", name=f"twin{j}",
                    **_frame(kinematics.relative_pose(joint, 0.0)))
        _joint(twin, joint, j, True)
        _add(twin, "inertial", pos="0 0 0.01", mass="0.002", diaginertia="2e-6 2e-6 2e-6")
        _add(equality, "weld", body1=f"twin{j}", body2=f"l{joint.b}", relpose="0 0 0 1 0 0 0",
             solref="0.005 1")
    apart = {frozenset((j.a, j.b)) for j in obj.joints}
    movable = [i for i, link in enumerate(obj.links) if not link.fixed]
    for n, i in enumerate(movable):
        _shape(bodies[i], obj.links[i])
        for geom in bodies[i].findall("geom"):
            geom.set("rgba", colours[n % len(colours)])
        for k in movable[n + 1:]:
            # Neighbours slide over each other; links that cross at the start stay so.
            if frozenset((i, k)) in apart or kinematics.rectangles_overlap(
                    obj.links[i], poses[i], obj.links[k], poses[k], 0.0):
                _add(contact, "exclude", body1=f"l{i}", body2=f"l{k}")
