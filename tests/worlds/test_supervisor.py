"""The supervisor's check against trying every mapping, and on structures that look alike."""

import itertools
import random
import unittest
from types import SimpleNamespace

from grrl_mujoco.supervisor import Supervisor, same_structure

SEED = 5


def every_mapping(n_a, joints_a, n_b, joints_b):
    """The naive check: true if one of n! mappings carries the joints over."""
    if n_a != n_b:
        return False
    want = {(kind, frozenset((a, b))) for kind, a, b in joints_b}
    return any({(kind, frozenset((p[a], p[b]))) for kind, a, b in joints_a} == want
               for p in itertools.permutations(range(n_a)))


def random_structure(rng, n):
    pairs = [(a, b) for a in range(n) for b in range(a)]
    chosen = rng.sample(pairs, min(len(pairs), rng.randint(0, n)))
    return [(rng.choice("RP"), a, b) for a, b in chosen]


def relabelled(rng, n, joints):
    order = list(range(n))
    rng.shuffle(order)
    joints = [(kind, order[a], order[b]) if rng.random() < 0.5 else (kind, order[b], order[a])
              for kind, a, b in joints]
    rng.shuffle(joints)
    return joints


def ring(first, n):
    return [("R", first + i, first + (i + 1) % n) for i in range(n)]


def model(n, joints):
    return SimpleNamespace(PRISMATIC=1, n_links=n, joint_type=[k == "P" for k, _, _ in joints],
                           joint_a=[a for _, a, _ in joints], joint_b=[b for _, _, b in joints])


class Check(unittest.TestCase):
    def test_like_every_mapping(self):
        rng = random.Random(SEED)
        same = 0
        for _ in range(400):
            n = rng.randint(1, 5)
            a = random_structure(rng, n)
            b = relabelled(rng, n, a) if rng.random() < 0.3 else random_structure(rng, n)
            with self.subTest(a=a, b=b, seed=SEED):
                expected = every_mapping(n, a, n, b)
                self.assertEqual(same_structure(n, a, n, b), expected)
                same += expected
        self.assertTrue(100 < same < 300, same)

    def test_any_order_of_links_is_the_same(self):
        rng = random.Random(SEED)
        for n in (8, 16, 32):
            tree = [(rng.choice("RP"), i, rng.randrange(i)) for i in range(1, n)]
            self.assertTrue(same_structure(n, tree, n, relabelled(rng, n, tree)))
            self.assertTrue(same_structure(n, ring(0, n), n, relabelled(rng, n, ring(0, n))))

    def test_alike_from_every_link_and_yet_different(self):
        self.assertFalse(same_structure(16, ring(0, 16), 16, ring(0, 8) + ring(8, 8)))

    def test_type_number_and_place_matter(self):
        truth = [("R", 0, 1), ("P", 1, 2), ("R", 2, 3)]
        self.assertTrue(same_structure(4, truth, 4, [("R", 3, 2), ("P", 2, 1), ("R", 1, 0)]))
        self.assertFalse(same_structure(4, truth, 4, [("R", 0, 1), ("R", 1, 2), ("P", 2, 3)]))
        self.assertFalse(same_structure(4, truth, 4, truth[:2]))
        self.assertFalse(same_structure(4, truth, 5, truth))
        self.assertFalse(same_structure(4, truth, 4, [*truth[:2], ("R", 2, 1)]))
        self.assertFalse(same_structure(4, truth, 4, [*truth[:2], ("R", 2, 2)]))

    def test_judges_models(self):
        supervisor = Supervisor(3, [("R", 0, 1), ("P", 1, 2)])
        self.assertTrue(supervisor.correct(model(3, [("P", 0, 2), ("R", 2, 1)])))
        self.assertFalse(supervisor.correct(model(3, [("P", 0, 2), ("P", 2, 1)])))
        self.assertFalse(supervisor.correct(model(2, [("R", 0, 1)])))
        self.assertFalse(supervisor.correct(model(0, [])))


if __name__ == "__main__":
    unittest.main()
