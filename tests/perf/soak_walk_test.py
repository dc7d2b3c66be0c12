#!/usr/bin/python3
"""What perf/soak_walk.py computes without drawing anything: its path, and its verdicts."""
import pathlib, sys, unittest

try:
    import numpy
except ImportError:
    print("NumPy is not installed: skipped")
    sys.exit(77)

PERF = pathlib.Path(__file__).resolve().parents[2] / "perf"
sys.path += [str(PERF), str(PERF / "scaling")]

from walk import soak, views  # noqa: E402


class Paths(unittest.TestCase):
    def test_random_walks_stay_in_their_box_and_never_turn_about(self):
        low, high = (0, -1, 1), (4, 1, 2)
        walk = views.random_walk(low, high, 300, seed=7)
        self.assertEqual(walk, views.random_walk(low, high, 300, seed=7))
        self.assertNotEqual(walk, views.random_walk(low, high, 300, seed=8))
        at = numpy.array([view["-vp"] for view in walk])
        self.assertTrue((at >= low).all() and (at <= high).all())
        self.assertTrue((at.max(axis=0) - at.min(axis=0) > 0.8 * numpy.subtract(high, low)).all())
        along = numpy.array([view["-vd"] for view in walk])
        numpy.testing.assert_allclose(numpy.linalg.norm(along, axis=1), 1)
        self.assertGreater((along[1:] * along[:-1]).sum(axis=1).min(), 0)
        self.assertLess((along[1:] * along[:-1]).sum(axis=1).min(), 0.9)


class Soak(unittest.TestCase):
    STILL = [(second, 100.0) for second in range(100)]

    def test_memory_that_stays_is_no_growth(self):
        self.assertLess(soak.growth([(s, 100 + 2 * (s % 3)) for s, _ in self.STILL]), 0.05)
        # What is fetched at the beginning does not count.
        self.assertEqual(soak.growth([(s, min(100, 20 * s + 10)) for s, _ in self.STILL]), 0)

    def test_tenths_are_of_the_frames_and_not_of_the_time(self):
        """A walk whose second half is drawn in a few seconds."""
        slow, fast = [(n, 100 + n) for n in range(0, 50)], [(n, 100 + n) for n in range(50, 101, 10)]
        self.assertAlmostEqual(soak.growth(slow + fast), (200 - 120) / 120)

    def test_a_leak_is_growth(self):
        self.assertGreater(soak.growth([(s, 100 + s) for s, _ in self.STILL]), 0.5)
        self.assertGreater(soak.growth([(s, 100 if s < 80 else 150) for s, _ in self.STILL]), 0.4)

    def test_verdicts(self):
        good = {"frames": 10, "drawn": 10, "status": 0, "growth": 0.01, "points": 399, "limit": 400}
        self.assertEqual(soak.faults(good, 0.1), [])
        for change in ({"status": -11}, {"drawn": 9}, {"growth": 0.2}, {"points": 401}):
            self.assertEqual(len(soak.faults({**good, **change}, 0.1)), 1, change)


if __name__ == "__main__":
    unittest.main()
