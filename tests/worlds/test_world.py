"""The physics: what a push does, how firmly it is limited, and that it comes out the same again."""

import math
import tempfile
import unittest
from types import SimpleNamespace

import numpy as np

from grrl_mujoco import kinematics, world
from grrl_mujoco.objects import parse_object
from grrl_mujoco.world import MAX_POINTS, World

NOISE_M = 0.0007


def push_at(scene, link, lever_share=1 / 3, **changes):
    """A push across a link, so much of its length from the centre."""
    x, y, angle = scene.poses()[link]
    across = (-math.sin(angle), math.cos(angle))
    lever = scene.object.links[link].length * lever_share
    at = (x + lever * math.cos(angle), y + lever * math.sin(angle))
    values = {"start": tuple(a - 0.06 * d for a, d in zip(at, across)),
              "end": tuple(a + 0.08 * d for a, d in zip(at, across)),
              "travel": 0.03, "speed": 0.08, "force": 10.0, "timeout": 2.5}
    return SimpleNamespace(**{**values, **changes})


def carry_out(scene, command):
    problem = scene.begin_push(command)
    assert not problem, problem
    frames = 1
    while scene.step_frame():
        frames += 1
        assert frames < 600
    return frames


def moved(before, after):
    return [math.dist(a[:2], b[:2]) for a, b in zip(before, after)]


class Pushes(unittest.TestCase):
    def test_moves_the_link_as_far_as_asked(self):
        for travel in (0.01, 0.03):
            scene = World(parse_object("l1"), [1], NOISE_M)
            before = scene.poses()
            carry_out(scene, push_at(scene, 0, 0.0, travel=travel))
            self.assertEqual(scene.reason, world.REACHED)
            self.assertAlmostEqual(moved(before, scene.poses())[0], travel, delta=0.003)
            self.assertIsNone(scene.finger_position())

    def test_force_limit_holds_it_back(self):
        scene = World(parse_object("l1"), [1], NOISE_M)
        before = scene.poses()
        carry_out(scene, push_at(scene, 0, force=0.05))  # the table holds it with 0.3 N and more
        self.assertEqual(scene.reason, world.BLOCKED)
        self.assertLess(moved(before, scene.poses())[0], 0.0005)

    def test_misses(self):
        scene = World(parse_object("l1"), [1], NOISE_M)
        x, y, _ = before = scene.poses()[0]
        away = (x + (0.4 if x < 0 else -0.4), y)
        carry_out(scene, push_at(scene, 0, start=away, end=(away[0], away[1] + 0.05)))
        self.assertEqual(scene.reason, world.MISSED)
        self.assertLess(math.dist(before[:2], scene.poses()[0][:2]), 1e-5)

    def test_times_out(self):
        scene = World(parse_object("l1"), [1], NOISE_M)
        carry_out(scene, push_at(scene, 0, timeout=0.2))
        self.assertEqual(scene.reason, world.TIMEOUT)

    def test_rest_is_rest(self):
        scene = World(parse_object("RPR"), [2], NOISE_M)
        carry_out(scene, push_at(scene, 0))
        before = scene.poses()
        for _ in range(30):
            self.assertFalse(scene.step_frame())
        self.assertEqual(before, scene.poses())

    def test_a_joint_moves_what_it_joins_and_keeps_its_limits(self):
        scene = World(parse_object("RPRPRPR"), [3], NOISE_M)
        for n in range(8):
            carry_out(scene, push_at(scene, n))
            poses = scene.poses()
            for joint in scene.object.joints:
                a, b = poses[joint.a], poses[joint.b]
                value = kinematics.joint_value(joint, a, b)
                self.assertTrue(joint.lower - 0.02 <= value <= joint.upper + 0.02)
                expected = kinematics.compose(a, kinematics.relative_pose(joint, value))
                self.assertLess(math.dist(expected[:2], b[:2]), 0.001)

    def test_loops_stay_closed(self):
        scene = World(parse_object("R(l1, R(l5, R(l4, R(l3, R(l2, l1)))))"), [4], NOISE_M)
        start = scene.poses()
        for n in range(5):
            carry_out(scene, push_at(scene, n))
            poses = scene.poses()
            for joint in scene.object.joints:
                ends = [kinematics.transform(poses[i], anchor) for i, anchor in
                        ((joint.a, joint.anchor_a), (joint.b, joint.anchor_b))]
                self.assertLess(math.dist(*ends), 0.001)
        self.assertGreater(max(moved(start, scene.poses())), 0.01)

    def test_the_background_holds_what_is_joined_to_it(self):
        scene = World(parse_object("R(lb, R(l1, l2))"), [5], NOISE_M)
        joint = next(j for j in scene.object.joints if scene.object.links[j.a].fixed)
        at = [kinematics.transform(scene.poses()[joint.b], joint.anchor_b)]
        carry_out(scene, push_at(scene, joint.b))
        at.append(kinematics.transform(scene.poses()[joint.b], joint.anchor_b))
        self.assertLess(math.dist(*at), 0.001)

    def test_refuses_what_no_robot_should_do(self):
        scene = World(parse_object("l1"), [1], NOISE_M)
        for changes, words in (({"start": (9.0, 0.0)}, "start"), ({"end": (math.nan, 0.0)}, "end"),
                               ({"start": (0.0, 0.0), "end": (0.0, 0.0)}, "same point"),
                               ({"speed": 0.6}, "speed"), ({"speed": math.nan}, "speed"),
                               ({"force": 11.0}, "force"), ({"travel": 0.0}, "travel"),
                               ({"timeout": 11.0}, "timeout")):
            with self.subTest(changes):
                self.assertIn(words, scene.begin_push(push_at(scene, 0, **changes)))
        self.assertEqual(scene.begin_push(push_at(scene, 0)), "")
        self.assertIn("going on", scene.begin_push(push_at(scene, 0)))


class Start(unittest.TestCase):
    def test_joints_start_where_they_were_drawn(self):
        """Whichever of its two links a joint hangs on."""
        for statement in ("link l1 0.1 0.03 0.1", "joint l2 l1 10 80 0.02 0.05 0 0.05 0",
                          "joint l1 l2 10 80 0.02 0.05 0 0.05 0"):
            for letter in "RP":
                if letter == "P":
                    statement = statement.replace("10 80", "0.01 0.03")
                with tempfile.NamedTemporaryFile("w", suffix=".grrl") as file:
                    file.write(f"term {letter}(l1, l2)\n{statement}\n")
                    file.flush()
                    scene = World(parse_object(file.name), [9], NOISE_M)
                joint, poses = scene.object.joints[0], scene.poses()
                value = kinematics.joint_value(joint, poses[joint.a], poses[joint.b])
                drawn = float(scene.data.qpos[scene.model.joint("j0").qposadr[0]])
                self.assertAlmostEqual(value, drawn, delta=1e-4)
                self.assertTrue(joint.initial[0] - 1e-4 <= value <= joint.initial[1] + 1e-4)


class Seeds(unittest.TestCase):
    @staticmethod
    def run_of(seed):
        scene = World(parse_object("PRP"), [seed, 1], NOISE_M)
        for n in range(2):
            carry_out(scene, push_at(scene, n))
        return scene.observe(), scene.data.qpos.tobytes()

    def test_same_seed_same_run_to_the_bit(self):
        self.assertEqual(self.run_of(7), self.run_of(7))
        self.assertNotEqual(self.run_of(7), self.run_of(8))


class Points(unittest.TestCase):
    def test_follow_their_links(self):
        scene = World(parse_object("RR"), [6], 0.0)
        carry_out(scene, push_at(scene, 1))
        poses = scene.poses()
        for number, x, y in zip(*scene.observe()):
            link, px, py = scene.points[number]
            expected = (px, py) if link < 0 else kinematics.transform(poses[link], (px, py))
            self.assertLess(math.dist(expected, (x, y)), 0.0005)  # the links are level but for that

    def test_noise_is_that_asked_for(self):
        scene = World(parse_object("RR"), [6], NOISE_M)
        frames = np.array([scene.observe()[1] for _ in range(200)])
        self.assertAlmostEqual(float(frames.std(axis=0).mean()) / NOISE_M, 1.0, delta=0.05)

    def test_ids_tell_no_links(self):
        scene = World(parse_object("RPRPRPR"), [6], NOISE_M)
        links = [link for link, _, _ in scene.points]
        changes = sum(a != b for a, b in zip(links, links[1:]))
        self.assertGreater(changes, len(links) / 2)

    def test_as_many_as_are_remembered_at_most(self):
        for text in ("l1", "RPRPRPR", "R" * 15):
            scene = World(parse_object(text), [6], NOISE_M)
            self.assertLessEqual(len(scene.points), MAX_POINTS)
            for link in scene.links:
                self.assertGreaterEqual(sum(owner == link for owner, _, _ in scene.points), 4)


if __name__ == "__main__":
    unittest.main()
