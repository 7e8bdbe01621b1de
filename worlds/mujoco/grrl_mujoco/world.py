"""The table with the object, the finger and the ideal camera above; one World is one trial.

Order of calls: World, then begin_push, then step_frame until it returns False, with observe for
each frame. The same object, seed and commands give the same run with the same build of MuJoCo.
"""

import math

import mujoco
import numpy as np

from . import kinematics
from .objects import draw_object, links_overlap
from .scene import (FINGER_RADIUS_M, LIFTED_M, STEP_S, STEPS_PER_FRAME, scene_xml)

TABLE_M = (2.2, 1.8)
BESIDE_TABLE_M = 0.5
FRAME_S = STEP_S * STEPS_PER_FRAME
MAX_POINTS = 192  # what grrl-agent remembers at a time; docs/messages.md
BACKGROUND_POINTS = 25
EDGE_M = 0.003
POINT_DISTANCE_M = 0.01

CONTACT_OFFSET_SIGMA_M = 0.004  # no two pushes are the same
DIRECTION_SIGMA_RAD = math.radians(4)
FRICTION_SPREAD = 0.15

BLOCKED_AFTER_S = 0.3
BACK_OFF_STEP_M = 0.005
MAX_BACK_OFF_M = 0.3
LANDING_CLEARANCE_M = 0.001
AT_REST_M_S = 0.001
MAX_SETTLE_S = 1.0

REACHED, MISSED, BLOCKED, TIMEOUT = 1, 2, 3, 4  # as in push_status_t


def check_push(command):
    """Empty if a push_command_t can be executed, else what is wrong and what would be right."""
    x, y = (side / 2 + BESIDE_TABLE_M for side in TABLE_M)
    for name, point in (("start", command.start), ("end", command.end)):
        if not (abs(point[0]) <= x and abs(point[1]) <= y):
            return (f"{name} ({point[0]:g}, {point[1]:g}) m is off the table; x must be within "
                    f"+-{x:g} and y within +-{y:g} m")
    if not math.dist(command.start, command.end) >= 0.001:
        return "start and end are the same point; they must be at least 0.001 m apart"
    for name, value, most, unit in (("speed", command.speed, 0.5, "m/s"),
                                    ("force limit", command.force, 10.0, "N"),
                                    ("travel", command.travel, 0.5, "m"),
                                    ("timeout", command.timeout, 10.0, "s")):
        if not 0 < value <= most:
            return f"{name} {value:g} {unit} must be above 0 and at most {most:g}"
    return ""


def _place(obj, rng):
    """Values of all joints and poses of all links: a random configuration on the table."""
    forest = kinematics.spanning_forest(obj.links, obj.joints)
    for attempt in range(200):
        bend = max(0.0, attempt - 40) / 200
        values = [rng.uniform(j.initial[0] + bend * (j.lower - j.initial[0]),
                              j.initial[1] + bend * (j.upper - j.initial[1]))
                  for j in obj.joints]
        if attempt == 199:
            values = [sum(j.initial) / 2 for j in obj.joints]
        values = kinematics.close_loops(obj.links, obj.joints, forest, values)
        if values is None or any(not j.lower <= v <= j.upper for j, v in zip(obj.joints, values)):
            continue
        flat = kinematics.link_poses(obj.links, obj.joints, forest, values)
        poses = _place_components(obj, forest, flat, rng)
        if poses is not None and not links_overlap(obj, poses, 0.003):
            return values, poses
    raise RuntimeError("the object does not fit on the table")


def _place_components(obj, forest, flat, rng):
    """Turns and moves each component until it is on the table and clear of the others."""
    poses = list(flat)
    done = []
    for c in range(len(forest.roots)):
        members = [i for i, owner in enumerate(forest.component)
                   if owner == c and not obj.links[i].fixed]
        if not members:
            continue
        for _ in range(30):
            turn = (0.0, 0.0, rng.uniform(-math.pi, math.pi))
            turned = {i: kinematics.compose(turn, flat[i]) for i in range(len(flat))
                      if forest.component[i] == c}
            outline = np.concatenate([kinematics.corners(obj.links[i], turned[i])
                                      for i in members])
            low, high = outline.min(axis=0), outline.max(axis=0)
            slack = np.array(TABLE_M) / 2 - 0.02 - (high - low) / 2
            slack = np.maximum(slack, 0.0)  # a long object extends over the edge
            shift = rng.uniform(-slack, slack) - (low + high) / 2
            moved = {i: (p[0] + shift[0], p[1] + shift[1], p[2]) for i, p in turned.items()}
            if not any(kinematics.rectangles_overlap(obj.links[i], moved[i], obj.links[k],
                                                     poses[k], 0.03)
                       for i in members for k in done):
                for i, pose in moved.items():
                    poses[i] = tuple(float(v) for v in pose)
                done += members
                break
        else:
            return None
    return poses


class World:
    """One trial. `seed` is a list of numbers for NumPy's generator."""

    def __init__(self, template, seed, noise_m):
        placing, self.pushing, self.noise = (
            np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(3))
        self.noise_m = noise_m
        self.object = draw_object(template, placing)
        values, poses = _place(self.object, placing)
        self.model = mujoco.MjModel.from_xml_string(scene_xml(self.object, poses))
        self.data = mujoco.MjData(self.model)
        for j, value in enumerate(values):
            self.data.qpos[self.model.joint(f"j{j}").qposadr[0]] = value
        self.finger_body = self.model.body("finger").id
        self.finger_geom = self.model.geom("finger").id
        self.guide = self.model.joint("guide")
        self.links = [i for i, link in enumerate(self.object.links) if not link.fixed]
        self.bodies = [self.model.body(f"l{i}").id for i in self.links]
        self.friction = self.model.geom_friction[:, 0].copy()
        self.dry = self.model.dof_frictionloss.copy()
        self.finger = None  # where it came down and along which direction
        self.pushing_now = self.settling = False
        self.reason = MISSED
        self._put_points(placing, poses)
        self._settle()

    # The camera.

    def _put_points(self, rng, poses):
        counts = {}
        for i in self.links:
            link = self.object.links[i]
            area = link.length * link.width / (0.13 * 0.035)
            counts[i] = int(min(max(rng.uniform(8, 14) * area, 6), 30))
        total = sum(counts.values())
        room = MAX_POINTS - (BACKGROUND_POINTS if total < MAX_POINTS - BACKGROUND_POINTS else 0)
        points = []
        for i, count in counts.items():
            if total > room:
                count = max(4, count * room // total)
            points += self._points_on_link(i, count, rng)
        for _ in range(min(BACKGROUND_POINTS, MAX_POINTS - len(points))):
            points += self._point_on_table(poses, points, rng)
        order = rng.permutation(len(points))
        self.points = [points[k] for k in order]  # by id: (link or -1, x, y)

    def _points_on_link(self, i, count, rng):
        link, chosen = self.object.links[i], []
        half = np.array([link.length / 2 - EDGE_M, link.width / 2 - EDGE_M])
        if link.shape != "box":
            half[0] -= link.width / 4  # keep off the rounded corners
        while len(chosen) < count:
            tries = rng.uniform(-half, half, (40, 2))
            apart = [min((math.dist(t, c[1:]) for c in chosen), default=1.0) for t in tries]
            good = next((k for k, d in enumerate(apart) if d >= POINT_DISTANCE_M),
                        int(np.argmax(apart)))
            chosen.append((i, float(tries[good][0]), float(tries[good][1])))
        return chosen

    def _point_on_table(self, poses, points, rng):
        """Adds one if a free place 5 cm from the others is found."""
        for _ in range(60):
            p = rng.uniform(-0.5, 0.5, 2) * TABLE_M
            near = any(i < 0 and math.dist(p, (x, y)) < 0.05 for i, x, y in points)
            if not near and not self._covered(p, poses, 0.01):
                return [(-1, float(p[0]), float(p[1]))]
        return []

    def _covered(self, point, poses, margin):
        return any(kinematics.distance_to_link(self.object.links[i], poses[i], point) <= margin
                   for i in self.links)

    def observe(self):
        """Ids, x and y of the visible points, ideal except for fresh noise."""
        poses = self.poses()
        ids, where = [], []
        for number, (i, x, y) in enumerate(self.points):
            if i < 0 and self._covered((x, y), poses, 0.0):
                continue
            if i < 0:
                where.append((x, y))
            else:
                body = self.bodies[self.links.index(i)]
                top = (x, y, self.object.links[i].height)
                world = self.data.xmat[body].reshape(3, 3) @ top + self.data.xpos[body]
                where.append((world[0], world[1]))
            ids.append(number)
        seen = np.array(where) + self.noise.normal(0.0, 1.0, (len(where), 2)) * self.noise_m
        return ids, seen[:, 0].tolist(), seen[:, 1].tolist()

    def poses(self):
        """Planar poses of all links, the truth."""
        poses = [(0.0, 0.0, 0.0)] * len(self.object.links)
        for i, body in zip(self.links, self.bodies):
            m = self.data.xmat[body]
            poses[i] = (float(self.data.xpos[body][0]), float(self.data.xpos[body][1]),
                        math.atan2(m[3], m[0]))
        return poses

    # The robot.

    def begin_push(self, command):
        """Starts a push; returns why not, or an empty text."""
        if self.pushing_now or self.settling:
            return "a push is going on; wait for its result"
        problem = check_push(command)
        if problem:
            return problem
        self._draw_friction()
        start, line = np.array(command.start), np.subtract(command.end, command.start)
        length = float(np.hypot(*line))
        turn = math.atan2(line[1], line[0]) + DIRECTION_SIGMA_RAD * self.pushing.normal()
        along = np.array([math.cos(turn), math.sin(turn)])
        offset = CONTACT_OFFSET_SIGMA_M * self.pushing.normal()
        start = start + offset * np.array([-along[1], along[0]])
        poses, back = self.poses(), 0.0
        reach = FINGER_RADIUS_M + LANDING_CLEARANCE_M
        while back <= MAX_BACK_OFF_M and self._covered(start - back * along, poses, reach):
            back += BACK_OFF_STEP_M
        self.command, self.line_m = command, length + back
        self.elapsed_s = self.progress_m = self.progress_s = 0.0
        self.contact_m = None
        self.pushing_now = True
        if back > MAX_BACK_OFF_M:
            self._finish(BLOCKED)
            return ""
        self._lower_finger(start - back * along, turn)
        return ""

    def _draw_friction(self):
        for values, drawn in ((self.model.geom_friction[:, 0], self.friction),
                              (self.model.dof_frictionloss, self.dry)):
            spread = self.pushing.uniform(1 - FRICTION_SPREAD, 1 + FRICTION_SPREAD, len(drawn))
            values[:] = drawn * spread

    def _lower_finger(self, at, angle):
        self.finger = (float(at[0]), float(at[1]), angle)
        self.model.body_pos[self.finger_body] = (at[0], at[1], 0.0)
        self.model.body_quat[self.finger_body] = (math.cos(angle / 2), 0, 0, math.sin(angle / 2))
        self.model.actuator_forcerange[0] = (-self.command.force, self.command.force)
        self.data.qpos[self.guide.qposadr[0]] = 0.0
        self.data.qvel[self.guide.dofadr[0]] = 0.0
        self.data.ctrl[0] = self.command.speed

    def _lift_finger(self):
        self.finger = None
        self.model.body_pos[self.finger_body] = (0.0, 0.0, LIFTED_M)
        self.data.qvel[self.guide.dofadr[0]] = 0.0
        self.data.ctrl[0] = 0.0

    def _finish(self, reason):
        self.reason = reason
        self.pushing_now, self.settling = False, True
        self.settled_s = 0.0
        self._lift_finger()

    def _travel(self):
        return float(self.data.qpos[self.guide.qposadr[0]])

    def _touches(self):
        contact = self.data.contact
        return self.finger_geom in contact.geom1 or self.finger_geom in contact.geom2

    def _check_finger(self):
        self.elapsed_s += STEP_S
        travel = self._travel()
        if self.contact_m is None and self._touches():
            self.contact_m = travel
        # Progress is a quarter of what the commanded speed would give, at most 0.5 mm.
        if travel > self.progress_m + min(0.0005, 0.25 * self.command.speed * BLOCKED_AFTER_S):
            self.progress_m, self.progress_s = travel, self.elapsed_s
        touched = self.contact_m is not None
        if touched and travel - self.contact_m >= self.command.travel:
            self._finish(REACHED)
        elif travel >= self.line_m:
            self._finish(REACHED if touched else MISSED)
        elif self.elapsed_s >= self.command.timeout:
            self._finish(TIMEOUT)
        elif self.elapsed_s - self.progress_s >= BLOCKED_AFTER_S:
            self._finish(BLOCKED)

    def finger_position(self):
        """The finger's position; None while it is lifted."""
        if self.finger is None:
            return None
        x, y, angle = self.finger
        travel = self._travel()
        return (x + travel * math.cos(angle), y + travel * math.sin(angle))

    # Time.

    def _greatest_speed(self):
        """The greatest speed of any link's centre or end in the plane, m/s."""
        fastest, velocity = 0.0, np.empty(6)
        for i, body in zip(self.links, self.bodies):
            mujoco.mj_objectVelocity(self.model, self.data, mujoco.mjtObj.mjOBJ_XBODY, body,
                                     velocity, 0)
            speed = math.hypot(velocity[3], velocity[4])
            fastest = max(fastest, speed + abs(velocity[2]) * self.object.links[i].length / 2)
        return fastest

    def _at_rest(self):
        self.settling = False
        self.data.qvel[:] = 0.0
        mujoco.mj_forward(self.model, self.data)

    def _settle(self):
        """Lets gravity press the feet onto the table before the first frame."""
        for _ in range(int(0.2 / STEP_S)):
            mujoco.mj_step(self.model, self.data)
        self._at_rest()

    def step_frame(self):
        """Advances 1/30 s. Whether a push is in progress or the object is not at rest yet."""
        for _ in range(STEPS_PER_FRAME):
            if not (self.pushing_now or self.settling):
                break  # dry friction: nothing moves by itself
            mujoco.mj_step(self.model, self.data)
            if self.pushing_now:
                self._check_finger()
            else:
                self.settled_s += STEP_S
                if self._greatest_speed() < AT_REST_M_S or self.settled_s >= MAX_SETTLE_S:
                    self._at_rest()
        return self.pushing_now or self.settling
