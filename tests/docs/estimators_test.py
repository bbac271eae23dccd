"""The decision tree of docs/how-to/choose-an-estimator.md against the figures that it rests on."""
import csv
import os
import re
import statistics
import unittest
from pathlib import Path

SOURCE = Path(os.environ["TWINMAP_SOURCE_DIR"])
PAGE = (SOURCE / "docs/how-to/choose-an-estimator.md").read_text()
MECHANISMS = (SOURCE / "docs/benchmarks/mechanisms.md").read_text()


def read_study():
    """(map, simulations, experiment) -> geometric mean of the ratio to the limit."""
    with open(SOURCE / "results/published/map_study/study.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    found = {}
    for row in rows:
        key = (row["map"], int(row["simulations"]), row["experiment"])
        if row["ratio_to_limit"]:
            found.setdefault(key, []).append(float(row["ratio_to_limit"]))
    return {key: statistics.geometric_mean(values) for key, values in found.items()}


def read_tree():
    return re.search(r"```text\n(.*?)```", PAGE, re.DOTALL)[1]


class Estimators(unittest.TestCase):
    study = read_study()

    def compare(self, better, worse, sizes):
        """(simulations, experiment) at which `better` is as near the limit, and all that both were run with."""
        all_of = [(n, e) for (m, n, e) in self.study if m == better and n in sizes and (worse, n, e) in self.study]
        near = [(n, e) for n, e in all_of if self.study[better, n, e] <= 1.05 * self.study[worse, n, e]]
        return near, all_of

    def test_the_tree_is_one_screen(self):
        self.assertLessEqual(len(read_tree().splitlines()), 24)

    def test_a_surrogate_is_the_default_for_its_errors_are_smaller_and_its_intervals_hold(self):
        rows = re.findall(
            r"^\| ([^|]+) \| ([\d. -]+) \| ([\d. -]+) \| ([\d. -]+) \| ([\d. -]+) \|$", PAGE, re.MULTILINE
        )
        self.assertGreaterEqual(len(rows), 8)
        numbers = [[[float(n) for n in re.findall(r"[\d.]+", cell)] for cell in row[1:]] for row in rows]
        smaller = [surrogate[-1] < gp[-1] for gp, _, surrogate, _ in numbers]
        self.assertGreaterEqual(sum(smaller), len(rows) - 1)
        for _, _, _, coverage in numbers:
            self.assertGreaterEqual(coverage[0], 0.93)

    def test_a_network_is_not_taken_for_accuracy_with_few_simulations(self):
        near, all_of = self.compare("surrogate", "network", (250,))
        self.assertGreaterEqual(len(all_of), 8)
        self.assertGreaterEqual(len(near), len(all_of) - 1)

    def test_networks_of_10000_simulations_beat_those_of_250(self):
        better = [
            e
            for (m, n, e) in self.study
            if (m, n) == ("network", 10000) and self.study["network", 250, e] >= 0.98 * self.study[m, n, e]
        ]
        self.assertGreaterEqual(len(better), 8)

    def test_refined_is_the_default_for_it_is_at_the_limit_on_every_mechanism(self):
        rows = re.findall(r"^\| \[\w+\]\(#\w+\) \|(.*)\|$", MECHANISMS, re.MULTILINE)
        self.assertGreaterEqual(len(rows), 8)
        for row in rows:
            ratios = [float(number) for number in re.findall(r"[\d.]+", row.split("|")[4])]
            # answers of few samples stand for many, which makes a figure uncertain by up to a tenth
            self.assertTrue(all(0.75 <= ratio <= 1.15 for ratio in ratios), row)

    def test_every_estimator_of_the_tree_exists(self):
        spec = (SOURCE / "framework/experiment/inverse_map_spec.hpp").read_text()
        for name in ("surrogate", "gp", "network", "automatic"):
            self.assertIn(f'"{name}"', spec)
            self.assertIn(name, read_tree())


if __name__ == "__main__":
    unittest.main()
