"""The term parser: by hand, and against grrl-term on random terms and damaged ones."""

import os
import random
import subprocess
import unittest

from grrl_mujoco.terms import MAX_LINKS, TermError, parse_term

GRRL_TERM = os.environ.get("GRRL_TERM", "")
SEED = 4


def library(text):
    """Links with properties and joints as the library reads them; None where it refuses."""
    done = subprocess.run([GRRL_TERM, "graph", text], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return None
    links, joints = {}, []
    for line in done.stdout.splitlines():
        words = line.split()
        if words[0] == "link":
            links[words[1]] = tuple(words[2:])
        else:
            joints.append(tuple(words[1:]))
    return links, joints


def ours(text):
    try:
        structure = parse_term(text)
    except TermError:
        return None
    stripped = {}
    for name, properties in structure.links.items():
        while properties and properties[-1] == "_":
            properties = properties[:-1]
        stripped[name] = properties
    return stripped, structure.joints


def random_term(rng, depth):
    # No more names than a small build holds links.
    name = rng.choice(["l1", "l2", "l3", "l4", "l5", "f1", "f2", "f3"])
    if depth == 0 or rng.random() < 0.2:
        properties = rng.choice([[], [], ["s"], ["l"], ["_", "s"]])
        return f"L({', '.join([*properties, name])})" if properties else name
    if rng.random() < 0.1:
        return f"{random_term(rng, depth - 1)} & {random_term(rng, depth - 1)}"
    arguments = [random_term(rng, depth - 1) for _ in range(rng.choice([2, 2, 2, 3]))]
    if rng.random() < 0.1:
        arguments.insert(0, "lb")
    return f"{rng.choice('RRPPD')}({', '.join(arguments)})"


class Terms(unittest.TestCase):
    def test_chain_runs_from_the_last_link_to_the_first(self):
        structure = parse_term("P(l4, R(R(l1, l2), l3))")
        self.assertEqual(list(structure.links), ["l4", "l1", "l2", "l3"])
        self.assertEqual(structure.joints,
                         [("R", "l1", "l2"), ("R", "l2", "l3"), ("P", "l4", "l1")])

    def test_branches_properties_and_background(self):
        structure = parse_term("D(lb, R(L(l, f1), L(s, f2), f3))")
        self.assertEqual(structure.links, {"f1": ("l",), "f2": ("s",), "f3": ()})
        self.assertEqual(structure.joints, [("R", "f1", "f2"), ("R", "f1", "f3")])

    def test_loop(self):
        joints = parse_term("R(l1, R(l3, R(l2, l1)))").joints
        self.assertEqual({frozenset(j[1:]) for j in joints},
                         {frozenset(p) for p in (("l1", "l2"), ("l2", "l3"), ("l1", "l3"))})

    def test_background_is_a_link_where_a_joint_asks_for_it(self):
        self.assertIn("lb", parse_term("R(lb, l1)").links)
        self.assertNotIn("lb", parse_term("D(lb, l1)").links)

    def test_errors_say_where_and_what(self):
        for text, column, words in (
            ("R(l1,", 6, "found the end"),
            ("R(l1)", 5, "a further argument"),
            ("R(l1, 3)", 7, "a link or one of"),
            ("R(l1, l2) l3", 11, "end of the text"),
            ("R(l1, l1)", 1, "joined to itself"),
            ("R(l1, l2) & P(l2, l1)", 13, "joined twice"),
            ("L(Q, l1)", 3, "a property"),
            ("R(L(s, l1), L(l, l1))", 18, "two sets"),
            ("", 1, "a link or one of"),
        ):
            with self.subTest(text), self.assertRaises(TermError) as caught:
                parse_term(text)
            self.assertEqual(caught.exception.column, column)
            self.assertIn(words, str(caught.exception))

    def test_too_many_links(self):
        text = "D(" + ", ".join(f"l{i}" for i in range(1, MAX_LINKS + 2)) + ")"
        with self.assertRaises(TermError):
            parse_term(text)

    @unittest.skipUnless(GRRL_TERM, "GRRL_TERM does not name the library's tool")
    def test_reads_what_the_library_reads(self):
        rng = random.Random(SEED)
        accepted = 0
        for n in range(150):
            text = random_term(rng, rng.randint(1, 4))
            if n % 3 == 0:
                at = rng.randrange(len(text))
                text = text[:at] + rng.choice(["", ",", ")", "(", "&", "x", " "]) + text[at + 1:]
            with self.subTest(text=text, seed=SEED):
                self.assertEqual(ours(text), library(text))
            accepted += ours(text) is not None
        self.assertGreater(accepted, 30)
        self.assertLess(accepted, 150)


if __name__ == "__main__":
    unittest.main()
