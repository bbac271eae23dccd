"""What Python costs: Map.predict() of many rows against the same by libtwinmap, and single calls.

Usage: PYTHONPATH=build/release/framework/python bench/python_predict.py build/release/framework/c_api/libtwinmap.so RUN...
RUN: folders of finished runs. One thread; the best of several times.
"""
import argparse
import ctypes
import os
import sys
import time
from pathlib import Path

import h5py
import numpy as np

import twinmap

REPEATS = 5
CALLS = 200  # of what takes microseconds


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("library", type=Path)
    parser.add_argument("runs", nargs="+", type=Path)
    parser.add_argument("--rows", type=int, default=100000)
    return parser.parse_args()


def measure(*functions):
    """Processor seconds of each; in turns, so that a busy machine disturbs all alike."""

    def once(function):
        start = time.process_time()
        function()
        return time.process_time() - start

    return np.min([[once(function) for function in functions] for _ in range(REPEATS)], axis=0)


def repeat(function, *arguments, **options):
    for _ in range(CALLS):
        function(*arguments, **options)


class Library:
    """libtwinmap's twinmap_predict for arrays."""

    def __init__(self, path, run):
        self.functions = ctypes.CDLL(str(path))
        self.map = ctypes.c_void_p()
        if self.functions.twinmap_open(os.fsencode(run), ctypes.byref(self.map)) != 0:
            sys.exit(f"{run}: cannot be opened")

    def predict(self, rows, mean, stddev):
        def point(array):
            return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))

        self.functions.twinmap_predict(
            self.map, point(rows), None, ctypes.c_size_t(len(rows)), 1, point(mean), point(stddev)
        )


def read_features(run, map_):
    """Of the run's test samples, without noise."""
    with h5py.File(run / "samples.h5") as file:
        responses = file["test/responses"][:]
    return twinmap.Experiment.from_yaml(map_.to_yaml()).extract(responses.reshape(len(responses), -1))


def main():
    arguments = parse_arguments()
    print(
        "| run | rows | library [s] | Python [s] | ratio | one row [us] | infer [us] |\n|---|--:|--:|--:|--:|--:|--:|"
    )
    for run in arguments.runs:
        map_ = twinmap.Map.load(run)
        features = read_features(run, map_)
        rows = np.ascontiguousarray(np.resize(features, (arguments.rows, features.shape[1])))
        mean, stddev = np.empty((2, len(rows), len(map_.parameters)))
        library = Library(arguments.library, run)
        by_library, by_python, one, infer = measure(
            lambda: library.predict(rows, mean, stddev),
            lambda: map_.predict(rows, return_std=True),
            lambda: repeat(map_.predict, features[:1], return_std=True),
            lambda: repeat(map_.infer, features[0], refine=False),
        )
        print(
            f"| {run.name} | {len(rows)} | {by_library:.3f} | {by_python:.3f} | {by_python / by_library:.2f} "
            f"| {1e6 * one / CALLS:.0f} | {1e6 * infer / CALLS:.0f} |"
        )


if __name__ == "__main__":
    main()
