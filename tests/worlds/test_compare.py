"""The table of worlds/mujoco/compare: means and intervals over seeds, not over trials."""

import importlib.machinery
import importlib.util
import os
import unittest
from types import SimpleNamespace

PATH = os.path.join(os.path.dirname(__file__), "..", "..", "worlds", "mujoco", "compare")
loader = importlib.machinery.SourceFileLoader("compare", PATH)
compare = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare", loader))
loader.exec_module(compare)


class Table(unittest.TestCase):
    def test_interval_is_that_of_student(self):
        mean, half = compare.interval([4.0, 5.0, 6.0, 9.0])
        self.assertAlmostEqual(mean, 6.0)
        self.assertAlmostEqual(half, 3.4371, places=3)  # 3.182 * 2.1602 / 2
        self.assertEqual(compare.interval([4.0]), (4.0, None))

    def test_rows(self):
        options = SimpleNamespace(seeds=2, trials=6, cap=60)
        rows = {1: [(t, 10, "discovered") for t in range(1, 7)],
                2: [(t, 60 if t == 1 else 6, "capped" if t == 1 else "discovered")
                    for t in range(1, 7)]}
        line = compare.table({("RPR", "learn"): rows}, options)[-1]
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        self.assertEqual(cells[:2], ["RPR", "learn"])
        self.assertEqual([cell.split(" ± ")[0] for cell in cells[2:6]],
                         ["12.5", "35.0", "13.4", "8.0"])
        self.assertEqual(cells[6], "8.3%")

    def test_names_of_objects_are_names_of_files(self):
        self.assertEqual(compare.plain("D(lb, R(l1, l2))"), "D-lb--R-l1--l2")
        self.assertEqual(compare.plain("sim/objects/scissors.grrl"), "scissors")


if __name__ == "__main__":
    unittest.main()
