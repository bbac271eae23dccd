"""The figures that bench/peers prints of answers beside true values, on hand-sized cases."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["TWINMAP_SOURCE_DIR"])
sys.path.insert(0, str(SOURCE / "bench" / "peers"))
from again import calc_difference, is_same  # noqa: E402
from cases import KINDS  # noqa: E402
from environments import Environments  # noqa: E402
from judge import compare, judge, list_better  # noqa: E402
from peers import PEERS  # noqa: E402


def answer(machine, mean, sd, warnings=(), intervals=None):
    return {
        "machine": machine,
        "mean": [mean],
        "sd": [sd],
        "intervals95": [intervals or [[mean - 1.96 * sd, mean + 1.96 * sd]]],
        "intervals50": [[[mean - 0.674 * sd, mean + 0.674 * sd]]],
        "warnings": list(warnings),
        "simulations": 100,
        "seconds": 1.0,
        "shared_simulations": 0,
        "shared_seconds": 0.0,
    }


def truths(*values):
    return [{"values": [value], "limits": [1.0]} for value in values]


class Judge(unittest.TestCase):
    def test_errors_are_over_the_limit(self):
        cell = judge([answer(1, 0.67449, 2.0), answer(2, -0.67449, 2.0)], truths(0, 0))
        self.assertAlmostEqual(cell.error, 1.0)
        self.assertAlmostEqual(cell.sd, 2.0)
        self.assertEqual((cell.covered95, cell.covered50), (1.0, 1.0))

    def test_silent_is_far_and_without_a_word(self):
        lines = [answer(1, 5.0, 1.0), answer(2, 5.0, 1.0, ["at a bound"]), answer(3, 3.0, 1.0)]
        cell = judge(lines, truths(0, 0, 0))
        self.assertEqual((cell.far, cell.silent, cell.warned), (2, 1, 1))

    def test_an_infinite_sd_is_never_far(self):
        lines = [answer(1, 1e9, float("inf"), intervals=[[float("-inf"), float("inf")]])]
        cell = judge(lines, truths(0))
        self.assertEqual((cell.silent, cell.covered95, cell.sd), (0, 1.0, float("inf")))

    def test_either_of_two_intervals_holds(self):
        cell = judge([answer(1, 0.0, 1.0, intervals=[[-3, -1], [1, 3]])], truths(2))
        self.assertEqual(cell.covered95, 1.0)

    def test_failures_are_counted(self):
        cell = judge([answer(1, 0.0, 1.0), {"machine": 2, "failed": "no"}], truths(0, 0))
        self.assertEqual((cell.asked, cell.answered, cell.failures), (2, 1, ["no"]))

    def test_peers_are_compared_on_machines_of_both(self):
        own = [answer(1, 0.1, 1.0), answer(2, 9.0, 1.0)]
        self.assertEqual(list_better([answer(1, 0.1, 1.0)], own, truths(0, 0)), [])
        self.assertIn("silent", list_better([answer(2, 0.1, 1.0)], own, truths(0, 0)))

    def test_an_error_is_better_where_chance_does_not_explain_it(self):
        known = truths(*[0] * 10)
        own = [answer(machine, 1.0 + 0.1 * machine, 1.0) for machine in range(1, 11)]
        nearer = [answer(machine, 0.5, 1.0) for machine in range(1, 11)]
        either = [answer(machine, 0.1 if machine % 2 else 3.0, 1.0) for machine in range(1, 11)]
        self.assertEqual(list_better(nearer, own, known), ["error"])
        self.assertEqual(list_better(either, own, known), [])
        self.assertEqual(list_better(nearer[:3], own, known), [])

    def test_less_time_is_better(self):
        quick = judge([dict(answer(1, 0.1, 1.0), seconds=0.5)], truths(0))
        self.assertEqual(compare(quick, judge([answer(1, 0.1, 1.0)], truths(0))), ["time"])


class Machines(unittest.TestCase):
    def count(self, peer, kind):
        (one,) = [each for each in PEERS if each.name == peer]
        return one.count_machines(next(each for each in KINDS if each.name == kind))

    def test_forty_where_an_answer_is_cheap(self):
        self.assertEqual([self.count("twinmap_infer", kind) for kind in ("closed_form", "servo_axis")], [40, 40])

    def test_ten_of_profiles_and_sbi_and_of_what_is_slow(self):
        self.assertEqual([self.count(peer, "two_beam") for peer in ("pypesto", "sbi_500", "sbi_10000")], [10, 10, 10])
        self.assertEqual(self.count("mujoco", "servo_axis"), 10)
        self.assertEqual(self.count("twinmap_infer", "seven_joint_arm"), 10)

    def test_what_is_slow_is_a_case(self):
        self.assertLessEqual({name for peer in PEERS for name in peer.slow}, {kind.name for kind in KINDS})


class Unreachable(Environments):
    """A registry that does not answer until it is asked again."""

    asked = 0

    def install(self, name):
        self.asked += 1
        if self.asked == 1:
            raise subprocess.CalledProcessError(100, ["/usr/bin/apt-get", "download"])


class Lacks(unittest.TestCase):
    def test_an_environment_that_cannot_be_had_says_why_until_it_can(self):
        with tempfile.TemporaryDirectory() as folder:
            one = Unreachable(Path(folder) / "env", Path(folder))
            one.make("torch")
            self.assertEqual(
                one.explain_lack("torch"), "its environment `torch` cannot be had: `apt-get` ends with status 100"
            )
            self.assertFalse(one.is_ready("torch"))
            one.make("torch")
            self.assertEqual((one.explain_lack("torch"), one.is_ready("torch")), ("", True))


class Again(unittest.TestCase):
    def test_seconds_may_differ(self):
        self.assertTrue(is_same(answer(1, 0.1, 1.0), dict(answer(1, 0.1, 1.0), seconds=9.0)))
        self.assertFalse(is_same(answer(1, 0.1, 1.0), answer(1, 0.1, 1.0, ["at a bound"])))

    def test_differences_are_over_the_sd(self):
        of_mean, of_sd = calc_difference(answer(1, 1.0, 2.0), answer(1, 4.0, 3.0))
        self.assertAlmostEqual(of_mean, 1.5)
        self.assertAlmostEqual(of_sd, 0.5)

    def test_infinite_sds_are_left_out(self):
        unknown = answer(1, 1.0, float("inf"))
        self.assertEqual(calc_difference(unknown, unknown), (0, 0))


if __name__ == "__main__":
    unittest.main()
