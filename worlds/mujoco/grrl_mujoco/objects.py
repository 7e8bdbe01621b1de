"""The object on the table: a description parsed once, and a random instance for each trial.

parse_object takes what grrl-sim takes: a chain (RPRPRPR), a term (R(l1, R(l5, ..))) or a file with
a term and dimensions (scissors.grrl). draw_object gives it the dimensions of one trial, from the
ranges in docs/mujoco.md: what a file fixes stays, masses and frictions are always this world's own.
Metres, kilograms, newtons, radians.
"""

import copy
import math
import re
from dataclasses import dataclass

from . import kinematics
from .terms import BACKGROUND, MAX_LINKS, TermError, parse_term

# (low, high), uniformly distributed. Documented in docs/mujoco.md.
LENGTH_M = {"": (0.11, 0.16), "s": (0.075, 0.095), "l": (0.165, 0.20)}
WIDTH_M = (0.030, 0.045)
HEIGHT_M = (0.018, 0.030)
LINE_DENSITY_KG_M = (1.6, 3.0)  # the same for all links of a trial, except for MASS_SPREAD
MASS_SPREAD = 0.15
TABLE_FRICTION = (0.20, 0.32)
FINGER_FRICTION = (0.15, 0.45)
REVOLUTE_FRICTION_N_M = (0.015, 0.045)
PRISMATIC_FRICTION_N = (0.7, 1.6)
REVOLUTE_LIMIT_RAD = (math.radians(80), math.radians(125))
PRISMATIC_LIMIT_M = (0.025, 0.04)
LOOP_FRICTION_SHARE = 1 / 3  # one push at a loop moves four joints or more at once
FILE_MASS_FACTOR = (1.2, 2.0)  # the masses and joint frictions of a file, in this world
FILE_FRICTION_FACTOR = (0.7, 1.5)
SHAPES = ("box", "rounded", "capsule")

SIDE_SLOT_SPACING_M = 0.045
LOOP_ATTEMPTS = 60
DRAWS = 20


class ObjectError(ValueError):
    """An invalid description of an object: what is wrong, where, and what would be right."""


@dataclass
class Link:
    """A bar whose frame lies in its centre, x along it, z from the table's surface."""

    name: str
    size: str = ""  # "s", "l" or neither
    fixed: bool = False  # lb: the table itself
    given: bool = False  # the file fixes its dimensions
    length: float = 0.13
    width: float = 0.035
    height: float = 0.024
    mass: float = 0.13
    shape: str = "box"


@dataclass
class Joint:
    """At value 0 the anchors coincide and b is rotated by angle against a; see relative_pose."""

    kind: str  # "R" or "P"
    a: int
    b: int
    given: bool = False
    anchor_a: tuple = (0.0, 0.0)
    anchor_b: tuple = (0.0, 0.0)
    angle: float = 0.0
    axis: float = 0.0
    lower: float = 0.0
    upper: float = 0.0
    friction: float = 0.0
    initial: tuple = (0.0, 0.0)


@dataclass
class Object:
    links: list
    joints: list
    table_friction: float = 0.0
    finger_friction: float = 0.0

    def visible(self):
        """Number of links without the background, and joints (kind, a, b) between those."""
        index = {}
        for i, link in enumerate(self.links):
            if not link.fixed:
                index[i] = len(index)
        joints = [
            (j.kind, index[j.a], index[j.b])
            for j in self.joints
            if j.a in index and j.b in index
        ]
        return len(index), joints


def _from_structure(structure):
    names = list(structure.links)
    links = [
        Link(name, size=next((p for p in structure.links[name][:1] if p in ("s", "l")), ""),
             fixed=name == BACKGROUND)
        for name in names
    ]
    joints = [Joint(kind, names.index(a), names.index(b)) for kind, a, b in structure.joints]
    return Object(links, joints)


def _from_chain(letters):
    if not letters:
        raise ObjectError("an empty chain; write one letter R or P for each joint")
    for i, letter in enumerate(letters):
        if letter not in "RP":
            raise ObjectError(f"1:{i + 1}: a chain has no letter '{letter}'; R is a revolute and P "
                              "a prismatic joint, such as RPRPRPR")
    if len(letters) >= MAX_LINKS:
        raise ObjectError(f"a chain of {len(letters)} joints has {len(letters) + 1} links; at most "
                          f"{MAX_LINKS} are possible")
    links = [Link(f"l{i + 1}") for i in range(len(letters) + 1)]
    return Object(links, [Joint(kind, i, i + 1) for i, kind in enumerate(letters)])


class _File:
    """The statements of sim/object_file.hpp."""

    def __init__(self, path, text):
        self.path = path
        self.object = None
        for number, line in enumerate(text.split("\n"), 1):
            self.number = number
            self.line = line
            words = [(m.group(), m.start() + 1)
                     for m in re.finditer(r"[^ \t\r]+", line.split("#")[0])]
            if words:
                self.statement(words)
        if self.object is None:
            self.number = 1
            self.fail(1, "there is no term; the first statement must be 'term R(l1, l2)' or "
                         "similar")

    def fail(self, column, text):
        raise ObjectError(f"{self.path}:{self.number}:{column}: {text}")

    def statement(self, words):
        keyword, column = words[0]
        if keyword not in ("term", "link", "joint"):
            self.fail(column, f"unknown statement '{keyword}'; expected term, link or joint")
        if keyword == "term":
            self.term(words)
        elif self.object is None:
            self.fail(column, "the term must come before links and joints")
        elif keyword == "link":
            self.link(words)
        else:
            self.joint(words)

    def term(self, words):
        if self.object is not None:
            self.fail(words[0][1], "a second term; a file has one")
        if len(words) < 2:
            self.fail(len(self.line) + 1, "expected a term such as R(l1, l2)")
        start = words[1][1] - 1
        try:
            self.object = _from_structure(parse_term(self.line[start:].split("#")[0]))
        except TermError as error:
            self.fail(start + error.column, error.text)

    def expect(self, words, least, most, form):
        if not least <= len(words) <= most:
            column = words[most][1] if len(words) > most else len(self.line) + 1
            self.fail(column, f"expected: {form}")

    def index(self, word):
        names = [link.name for link in self.object.links]
        if word[0] not in names:
            self.fail(word[1], f"the term has no link '{word[0]}'; it has {', '.join(names)}")
        return names.index(word[0])

    def number_in(self, word, what, least, most):
        try:
            value = float(word[0])
        except ValueError:
            value = math.nan
        if not least <= value <= most:
            self.fail(word[1], f"{what} '{word[0]}' must be a number from {least:g} to {most:g}")
        return value

    def link(self, words):
        self.expect(words, 5, 5, "link NAME length_m width_m mass_kg")
        link = self.object.links[self.index(words[1])]
        link.length = self.number_in(words[2], "the length", 0.02, 1.0)
        link.width = self.number_in(words[3], "the width", 0.01, 1.0)
        link.mass = self.number_in(words[4], "the mass", 0.01, 10.0)
        link.given = True

    def joint(self, words):
        self.expect(words, 10, 12, "joint A B lower upper friction anchor_a_x anchor_a_y "
                                   "anchor_b_x anchor_b_y [axis [angle]]")
        a, b = self.index(words[1]), self.index(words[2])
        joint = next((j for j in self.object.joints if {j.a, j.b} == {a, b}), None)
        if joint is None:
            self.fail(words[1][1],
                      f"the term has no joint between {words[1][0]} and {words[2][0]}")
        turns = joint.kind == "R"
        most, unit = (180.0, math.pi / 180) if turns else (1.0, 1.0)
        joint.a, joint.b, joint.given = a, b, True
        joint.lower = unit * self.number_in(words[3], "the lower limit", -most, most)
        joint.upper = unit * self.number_in(words[4], "the upper limit", -most, most)
        joint.friction = self.number_in(words[5], "the friction", 0.0, 100.0)
        anchors = [self.number_in(word, "the anchor", -1.0, 1.0) for word in words[6:10]]
        joint.anchor_a, joint.anchor_b = tuple(anchors[:2]), tuple(anchors[2:])
        angles = [math.radians(self.number_in(word, what, -360, 360))
                  for word, what in zip(words[10:], ("the axis", "the angle"))]
        joint.axis, joint.angle = (angles + [0.0, 0.0])[:2]
        if joint.lower >= joint.upper:
            self.fail(words[4][1], "the upper limit must be above the lower one")
        middle, part = (joint.lower + joint.upper) / 2, (joint.upper - joint.lower) / 4
        joint.initial = (middle - part, middle + part)


def parse_object(text):
    """A chain, a term, or else the path of a file. ObjectError says what is wrong."""
    try:
        if "(" in text or "&" in text:
            return _checked(_from_structure(parse_term(text)))
        if not re.search(r"[./\\]", text):
            if re.fullmatch(r"[A-Z]*", text):
                return _from_chain(text)
            if not re.fullmatch(r"[lfv][0-9]+|lb", text.strip()):
                raise ObjectError(f"'{text}' is not a chain such as RPR and not the path of a file; write "
                                  f"a single link of this name as L({text})")
            return _checked(_from_structure(parse_term(text)))
    except TermError as error:
        raise ObjectError(str(error)) from None
    try:
        with open(text, encoding="utf-8") as file:
            return _checked(_File(text, file.read()).object)
    except (OSError, UnicodeDecodeError):
        raise ObjectError(f"{text}: cannot be read; expected a file of dimensions, a chain such as "
                          "RPR or a term such as R(l1, l2)") from None


def _checked(template):
    if template.visible()[0] == 0:
        raise ObjectError("there is no link that could be pushed, the background alone is none")
    return template


def _neighbours(obj, link):
    return [j.b if j.a == link else j.a for j in obj.joints if link in (j.a, j.b)]


def _on_loop(obj, joint):
    """Whether b can be reached from a without the joint."""
    reached, queue = {joint.a}, [joint.a]
    while queue:
        i = queue.pop()
        for j in obj.joints:
            if j is not joint and i in (j.a, j.b):
                k = j.b if j.a == i else j.a
                if k not in reached:
                    reached.add(k)
                    queue.append(k)
    return joint.b in reached


class _Layout:
    """Joins links at their ends, further ones along their sides, as sim/layout.cpp does."""

    def __init__(self, obj):
        self.obj = obj
        self.used = [0] * len(obj.links)
        self.seen = [False] * len(obj.links)
        self.entered = [False] * len(obj.links)
        self.loop = [_on_loop(obj, joint) for joint in obj.joints]
        for i, link in enumerate(obj.links):
            link.length = max(link.length, SIDE_SLOT_SPACING_M * self.per_side(i))
        for root in sorted(range(len(obj.links)), key=lambda i: not obj.links[i].fixed):
            if not self.seen[root]:
                self.walk(root)

    def per_side(self, link):
        return (len(_neighbours(self.obj, link)) - 1) // 2

    def next_slot(self, i):
        link, k = self.obj.links[i], self.used[i]
        self.used[i] += 1
        if k < 2:
            far = (k == 0) != self.entered[i]
            return ((link.length / 2 if far else -link.length / 2, 0.0), 0.0 if far else math.pi)
        sign = 1 if k % 2 == 0 else -1
        place = ((k - 2) // 2 + 0.5) / self.per_side(i)
        x = (2 * place - 1) * link.length / 2
        return ((x, sign * link.width / 2), sign * math.pi / 2)

    def walk(self, root):
        placed, path = set(), [root]
        self.seen[root] = True
        while path:
            link = path[-1]
            waiting = [j for j, joint in enumerate(self.obj.joints)
                       if j not in placed and link in (joint.a, joint.b)]
            if not waiting:
                path.pop()
                continue
            j = next((j for j in waiting if self.loop[j]), waiting[0])
            placed.add(j)
            joint = self.obj.joints[j]
            other = joint.b if joint.a == link else joint.a
            if not self.seen[other]:
                self.seen[other] = self.entered[other] = True
                path.append(other)
            start, end = self.next_slot(link), self.next_slot(other)
            if joint.given:
                continue
            joint.a, joint.b = link, other
            joint.anchor_a, joint.axis = start
            joint.anchor_b = end[0]
            joint.angle = kinematics.wrap(start[1] - end[1] + math.pi)


def _draw_link(link, density, rng):
    link.height = rng.uniform(*HEIGHT_M)
    link.shape = SHAPES[rng.integers(len(SHAPES))]
    if link.given:
        link.mass *= rng.uniform(*FILE_MASS_FACTOR)
    else:
        link.length = rng.uniform(*LENGTH_M[link.size])
        link.width = rng.uniform(*WIDTH_M)
        link.mass = density * link.length * rng.uniform(1 - MASS_SPREAD, 1 + MASS_SPREAD)
    if link.length < 1.5 * link.width:
        link.shape = "box"
    elif link.shape == "capsule":
        link.height = link.width


def _draw_joint(joint, rng):
    if joint.given:
        joint.friction *= rng.uniform(*FILE_FRICTION_FACTOR)
        return
    turns = joint.kind == "R"
    joint.upper = rng.uniform(*(REVOLUTE_LIMIT_RAD if turns else PRISMATIC_LIMIT_M))
    joint.lower = -joint.upper
    joint.friction = rng.uniform(*(REVOLUTE_FRICTION_N_M if turns else PRISMATIC_FRICTION_N))
    reach = math.radians(20) if turns else joint.upper / 2
    joint.initial = (-reach, reach)


def _close(obj, loop, rng):
    """Turns the corners of every loop until it closes, which is the zero of its joints.

    Returns an empty text, or why it cannot."""
    problem = ("does not close: no link may be longer than the others together, and the limits "
               "must allow a closed position")
    hinged = copy.deepcopy(obj)
    for j, joint in enumerate(hinged.joints):
        if loop[j] and not joint.given:
            joint.kind = "R"
    forest = kinematics.spanning_forest(hinged.links, hinged.joints)
    corners = sum(on and not joint.given for on, joint in zip(loop, hinged.joints))
    for attempt in range(LOOP_ATTEMPTS):
        values = []
        for on, joint in zip(loop, hinged.joints):
            if joint.given:
                values.append(rng.uniform(joint.lower, joint.upper))
            elif on:
                values.append(2 * math.pi / corners if attempt == 0 else rng.uniform(-2.5, 2.5))
            else:
                values.append(0.0)
        values = kinematics.close_loops(hinged.links, hinged.joints, forest, values)
        if values is None or any(joint.given and not joint.lower <= value <= joint.upper
                                 for joint, value in zip(hinged.joints, values)):
            continue
        poses = kinematics.link_poses(hinged.links, hinged.joints, forest, values)
        if links_overlap(hinged, poses, 0.002) and attempt < LOOP_ATTEMPTS - 1:
            continue
        closed = copy.deepcopy(obj.joints)
        for on, joint, value in zip(loop, closed, values):
            if on and not joint.given:
                joint.angle = kinematics.wrap(joint.angle + value)
                joint.friction *= LOOP_FRICTION_SHARE
        at = [value if joint.given else 0.0 for joint, value in zip(closed, values)]
        if not all(kinematics.movable_joints(obj.links, closed, forest, at)):
            problem = ("has a joint that cannot move; a planar loop needs at least 4 joints (3 if "
                       "all are prismatic)")
            continue
        obj.joints = closed
        return ""
    return problem


def links_overlap(obj, poses, margin):
    """Links that share no joint come nearer than the margin."""
    joined = {frozenset((j.a, j.b)) for j in obj.joints}
    movable = [i for i, link in enumerate(obj.links) if not link.fixed]
    return any(
        frozenset((i, k)) not in joined
        and kinematics.rectangles_overlap(obj.links[i], poses[i], obj.links[k], poses[k], margin)
        for n, i in enumerate(movable)
        for k in movable[n + 1:]
    )


def draw_object(template, rng):
    """One trial's object. ObjectError: its loops cannot close."""
    for _ in range(DRAWS):
        obj = copy.deepcopy(template)
        obj.table_friction = rng.uniform(*TABLE_FRICTION)
        obj.finger_friction = rng.uniform(*FINGER_FRICTION)
        density = rng.uniform(*LINE_DENSITY_KG_M)
        for link in obj.links:
            if not link.fixed:
                _draw_link(link, density, rng)
        for joint in obj.joints:
            _draw_joint(joint, rng)
        loop = _Layout(obj).loop
        problem = _close(obj, loop, rng) if any(loop) else ""
        if not problem:
            return obj
    names = sorted({obj.links[i].name for on, j in zip(loop, obj.joints) if on for i in (j.a, j.b)})
    raise ObjectError(f"the loop through {', '.join(names)} {problem}")


__all__ = ["Joint", "Link", "Object", "ObjectError", "draw_object", "links_overlap",
           "parse_object"]
