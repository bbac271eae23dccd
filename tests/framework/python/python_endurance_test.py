"""Many calls leave no memory behind."""
import gc
import resource
import unittest
from pathlib import Path

import twinmap
from case_turns import count_turn
from package_support import TABLE_1, run_once


def read_resident_size():
    """Bytes."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize()


class Endurance(unittest.TestCase):
    MOST = 4e6  # bytes that the allocator may come to need; a leak of 40 bytes a call is as much, of 200 in the turn of a commit

    def expect_no_leak(self, call, count=100_000):
        count = count_turn(count)
        for _ in range(count // 10):
            call()
        gc.collect()
        before = read_resident_size()
        for _ in range(count):
            call()
        gc.collect()
        self.assertLess(read_resident_size() - before, self.MOST)

    def test_predictions(self):
        experiment, results = run_once(TABLE_1)
        map_ = results.map
        row = experiment.extract(experiment.simulate({}))
        self.expect_no_leak(lambda: map_.predict(row, return_std=True))

    def test_inferences(self):
        experiment, results = run_once(TABLE_1)
        map_ = results.map
        frame = experiment.simulate({}).to_frame()
        columns = {name: frame[name].to_numpy() for name in frame}
        self.expect_no_leak(lambda: map_.infer(columns, refine=False), 10_000)

    def test_simulations_and_errors(self):
        experiment = twinmap.Experiment.from_file(TABLE_1)
        point = [[1.0, 2e-4, 7.0, 0.03]]

        def call():
            experiment.extract(experiment.simulate(point, threads=1))
            try:
                experiment.simulate({"none": 1})
            except twinmap.ExperimentError:
                pass

        self.expect_no_leak(call, 10_000)

    def test_experiments_and_maps(self):
        _, results = run_once(TABLE_1)

        def call():
            twinmap.Experiment.from_file(TABLE_1).override(seed=2)
            twinmap.Map.load(results.folder)

        self.expect_no_leak(call, 500)
