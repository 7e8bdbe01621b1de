"""Objects: what the descriptions of grrl-sim become here, drawn anew for every trial."""

import math
import os
import tempfile
import unittest

import numpy as np

from grrl_mujoco import kinematics, objects
from grrl_mujoco.objects import ObjectError, draw_object, parse_object

ROOT = os.path.join(os.path.dirname(__file__), "..", "..")
FIVE = "R(l1, R(l5, R(l4, R(l3, R(l2, l1)))))"


def from_text(text):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "x.grrl")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return parse_object(path)


class Descriptions(unittest.TestCase):
    def test_chain_and_term_are_the_same(self):
        joints = [("R", 0, 1), ("P", 1, 2)]
        self.assertEqual(parse_object("RP").visible(), (3, joints))
        n, from_term = parse_object("P(R(l1, l2), l3)").visible()
        self.assertEqual((n, sorted(from_term)), (3, sorted(joints)))

    def test_the_background_is_not_seen(self):
        self.assertEqual(parse_object("D(R(lb, l1), P(l2, l3))").visible(), (3, [("P", 1, 2)]))

    def test_every_object_of_the_simulator(self):
        folder = os.path.join(ROOT, "sim", "objects")
        names = [name for name in os.listdir(folder) if name.endswith(".grrl")]
        self.assertGreaterEqual(len(names), 3)
        for name in names:
            with self.subTest(name):
                obj = draw_object(parse_object(os.path.join(folder, name)),
                                  np.random.default_rng(1))
                self.assertGreater(len(obj.joints), 0)

    def test_what_a_file_fixes_stays(self):
        text = ("term P(l4, R(l1, l2)) # a comment\nlink l1 0.15 0.04 0.16\n"
                "joint l1 l4 -0.03 0.02 0.6 -0.075 0.0 0.07 0.01 180 30\n")
        template = from_text(text)
        for seed in range(5):
            obj = draw_object(template, np.random.default_rng(seed))
            link = next(link for link in obj.links if link.name == "l1")
            self.assertEqual((link.length, link.width), (0.15, 0.04))
            self.assertTrue(0.16 * 1.2 <= link.mass <= 0.16 * 2.0)
            joint = next(j for j in obj.joints if j.given)
            self.assertEqual((joint.lower, joint.upper), (-0.03, 0.02))
            self.assertEqual((joint.anchor_a, joint.anchor_b), ((-0.075, 0.0), (0.07, 0.01)))
            self.assertAlmostEqual(joint.axis, math.pi)
            self.assertAlmostEqual(joint.angle, math.pi / 6)

    def test_errors_say_where_and_what(self):
        for text, where in (
            ("link l1 1 1 1\n", ":1:1: the term must come before"),
            ("\nterm R(l1, 3)\n", ":2:12: expected a link"),
            ("term R(l1, l2)\nterm R(l1, l2)\n", ":2:1: a second term"),
            ("term R(l1, l2)\nlink l3 0.1 0.1 0.1\n", ":2:6: the term has no link 'l3'"),
            ("term R(l1, l2)\nlink l1 9 0.1 0.1\n", ":2:9: the length '9' must be a number from"),
            ("term R(l1, l2)\nlink l1 nan 0.1 0.1\n", ":2:9: the length"),
            ("term R(l1, l2)\njoint l1 l2 5 4 0 0 0 0 0\n", ":2:15: the upper limit"),
            ("term R(l1, l2)\njoint l1 l2 5\n", ":2:14: expected: joint A B"),
            ("# nothing\n", ":1:1: there is no term"),
            ("leg l1\n", ":1:1: unknown statement 'leg'"),
        ):
            with self.subTest(text), self.assertRaises(ObjectError) as caught:
                from_text(text)
            self.assertIn(where, str(caught.exception))
        for text in ("", "RXR", "R" * 16, "no/such.grrl", "R(l1", "D(lb, lb)", "rpr"):
            with self.subTest(text), self.assertRaises(ObjectError):
                parse_object(text)

    def test_a_loop_that_cannot_move_is_refused(self):
        with self.assertRaises(ObjectError) as caught:
            draw_object(parse_object("R(l1, R(l3, R(l2, l1)))"), np.random.default_rng(1))
        self.assertIn("cannot move", str(caught.exception))


class Drawing(unittest.TestCase):
    def test_every_trial_is_another_object_within_the_ranges(self):
        drawn = [draw_object(parse_object("RPRP"), np.random.default_rng(seed))
                 for seed in range(40)]
        lengths = [link.length for obj in drawn for link in obj.links]
        low, high = objects.LENGTH_M[""]
        self.assertTrue(low <= min(lengths) and max(lengths) <= high)
        self.assertGreater(max(lengths) - min(lengths), 0.8 * (high - low))
        self.assertEqual({link.shape for obj in drawn for link in obj.links}, set(objects.SHAPES))
        self.assertEqual(len({obj.table_friction for obj in drawn}), 40)

    def test_sizes(self):
        obj = draw_object(parse_object("R(L(s, f1), L(l, f2))"), np.random.default_rng(2))
        self.assertLess(obj.links[0].length, 0.1)
        self.assertGreater(obj.links[1].length, 0.16)

    def test_joints_of_a_chain_meet_end_to_end(self):
        obj = draw_object(parse_object("RPR"), np.random.default_rng(3))
        forest = kinematics.spanning_forest(obj.links, obj.joints)
        poses = kinematics.link_poses(obj.links, obj.joints, forest, [0.0] * 3)
        for k in range(3):
            apart = math.dist(poses[k][:2], poses[k + 1][:2])
            self.assertAlmostEqual(apart, (obj.links[k].length + obj.links[k + 1].length) / 2)

    def test_branches_slide_sideways(self):
        obj = draw_object(parse_object("P(l1, l2, l3, l4)"), np.random.default_rng(3))
        self.assertEqual([round(math.degrees(j.axis)) for j in obj.joints], [0, 180, 90])

    def test_loops_close(self):
        for text in (FIVE, "P(l1, R(l4, R(l3, R(l2, l1))))"):
            for seed in range(3):
                obj = draw_object(parse_object(text), np.random.default_rng(seed))
                forest = kinematics.spanning_forest(obj.links, obj.joints)
                values = kinematics.close_loops(obj.links, obj.joints, forest,
                                                [0.0] * len(obj.joints))
                self.assertIsNotNone(values, text)
                self.assertLess(max(map(abs, values)), 1e-5)  # closed at the joints' zero
                self.assertTrue(all(kinematics.movable_joints(obj.links, obj.joints, forest,
                                                              values)))


if __name__ == "__main__":
    unittest.main()
