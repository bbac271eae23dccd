"""Every interface gives the same estimate, whatever made it: JSON, CSV and text of the command, Python, the C library,
exported C and exported FMUs."""
import csv
import ctypes
import io
import json
import os
import re
import subprocess
import unittest
import xml.etree.ElementTree as ElementTree
import zipfile

import numpy as np
import pandas as pd

import twinmap
from package_support import FolderTestCase
from support import call, run_once
from export_test import Block2, compile_c

# A cart on a spring, whose response determines both parameters.
CART = """
name: cart
parameters: {k: {bounds: [80, 120]}, d: {bounds: [1, 2]}}
system:
  bodies: {cart: {mass: 2, joint: {type: slider, coordinates: [y]}}}
  springs: [{coordinate: y, stiffness: k}]
  dampers: [{coordinate: y, damping: d}]
initial: {coordinates: {y: 0.1}}
outputs: {y: {coordinate: y}}
simulation: {duration: 2}
features: [{samples: {outputs: [y], start: 0.05, interval: 0.05, count: 40}}]
noise: {stddev: {y: 1e-3}}
design: {train: {samples: 60}, test: {samples: 60}}
evaluation: {limit: false}
"""
# The same response for e and -e: two values fit.
SIGN = (
    CART.replace("name: cart", "name: sign")
    .replace("k: {bounds: [80, 120]}", "e: {bounds: [-1, 1], relative_to: range}")
    .replace("stiffness: k", "stiffness: 80 + 40 * e^2")
)
# Of two springs in parallel the response determines the sum alone: what is known of each is nearly uniform.
SPRINGS = (
    CART.replace("name: cart", "name: springs")
    .replace("k: {bounds: [80, 120]}", "k: {bounds: [40, 60]}, other: {bounds: [40, 60]}")
    .replace(
        "springs: [{coordinate: y, stiffness: k}]",
        "springs: [{coordinate: y, stiffness: k}, {coordinate: y, stiffness: other}]",
    )
)
NETWORK = "inverse_map={network: {samples_from: simulations, hidden: [8], steps: %d, batch: 256%s}}"
# name -> (experiment, overrides of its run, refine, method)
KINDS = {
    "gp": (CART, ["inverse_map=gp"], False, "gp"),
    "surrogate": (CART, ["inverse_map=surrogate"], False, "surrogate"),
    "network": (CART, [NETWORK % (150, "")], False, "network"),
    "mixture": (SIGN, [NETWORK % (600, ", head: mixture"), "design.train.samples=600"], False, "network"),
    "not normal": (SPRINGS, [NETWORK % (300, ""), "design.train.samples=4000"], False, "network"),
    "refined": (CART, ["inverse_map=surrogate"], True, "refined"),
    "posterior": (SIGN, ["inverse_map=surrogate"], True, "posterior"),  # both signs fit
}
DRIVER = r"""
#include <stdio.h>
#include "twinmap_map.h"
static twinmap_state state;
int main(void)
{
  static double times[TWINMAP_GRID], values[TWINMAP_GRID];
  const twinmap_real *signals[1] = {values};
  twinmap_result r;
  int i, j;
  for (i = 0; i < TWINMAP_GRID; ++i) {
    if (scanf("%lf %lf", &times[i], &values[i]) != 2) {
      return 1;
    }
  }
  if (twinmap_infer(&state, TWINMAP_GRID, times, signals, 0.0, NULL, &r) != TWINMAP_OK) {
    return 1;
  }
  for (i = 0; i < TWINMAP_PARAMETERS; ++i) {
    printf("%.17g %.17g %.17g %.17g", r.mean[i], r.sd[i], r.lower[i], r.upper[i]);
    for (j = 0; j < TWINMAP_PARAMETERS; ++j) {
      printf(" %.17g", r.covariance[i * TWINMAP_PARAMETERS + j]);
    }
    printf("\n");
  }
  return 0;
}
"""
# Exported C may be compiled for another processor: these digits of a standard deviation are the same (docs/how-to/export-to-a-controller.md).
DIGITS = 1e-6


class Library:
    """The estimate of a file by libtwinmap."""

    def __init__(self, run, refine, measured, parameters):
        library = ctypes.CDLL(os.environ["TWINMAP_LIBRARY"])
        library.twinmap_get_method.restype = library.twinmap_get_status.restype = ctypes.c_char_p
        library.twinmap_get_json.restype = ctypes.c_char_p
        library.twinmap_count_statuses.restype = ctypes.c_size_t
        map_, inferrer = ctypes.c_void_p(), ctypes.c_void_p()

        def require(result):
            assert result == 0, result

        def get(name, *arrays):
            pointers = [array.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) for array in arrays]
            require(getattr(library, name)(inferrer, *pointers, ctypes.c_size_t(arrays[0].size)))

        require(library.twinmap_open(os.fsencode(run), ctypes.byref(map_)))
        require(library.twinmap_new_inferrer(map_, 2 if refine else 0, ctypes.byref(inferrer)))
        require(library.twinmap_infer_file(inferrer, os.fsencode(measured)))
        self.mean, self.stddev, self.lower, self.upper = np.empty((4, parameters))
        self.covariance = np.empty((parameters, parameters))
        get("twinmap_get_mean", self.mean)
        get("twinmap_get_stddev", self.stddev)
        get("twinmap_get_interval", self.lower, self.upper)
        get("twinmap_get_covariance", self.covariance)
        self.method = library.twinmap_get_method(inferrer).decode()
        self.statuses = [
            library.twinmap_get_status(inferrer, ctypes.c_size_t(i)).decode()
            for i in range(library.twinmap_count_statuses(inferrer))
        ]
        self.json = json.loads(library.twinmap_get_json(inferrer))
        library.twinmap_close_inferrer(inferrer)
        library.twinmap_close(map_)


class Interfaces(FolderTestCase):
    def train(self, kind):
        """(run, measurement, expected: the command's JSON)"""
        text, overrides, refine, _ = KINDS[kind]
        file = self.folder / f"{text.split()[1]}.yaml"
        file.write_text(text)
        run, _ = run_once(file, *overrides, "refine=never")
        folder = self.folder / kind.replace(" ", "_")
        folder.mkdir()
        measured = folder / "measured.csv"
        at = ["parameters.d=1.4"] + (["parameters.e=0.6"] if kind in ("mixture", "posterior") else [])
        result = call("simulate", file, "--noise", "--csv", measured, *at)
        self.assertEqual(result.returncode, 0, result.stderr)
        return run, measured, json.loads(self.infer(run, measured, refine, "--json"))

    def infer(self, run, measured, refine, *options):
        result = call("infer", run, measured, "--refine" if refine else "--no-refine", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_every_interface_gives_the_same_estimate(self):
        for kind, (_, _, refine, method) in KINDS.items():
            with self.subTest(kind=kind):
                run, measured, expected = self.train(kind)
                self.assertEqual(expected["method"], method)
                self.check_intervals(kind, expected["parameters"])
                self.check_csv_and_text(
                    self.infer(run, measured, refine, "--csv"), self.infer(run, measured, refine), expected
                )
                library = Library(run, refine, measured, len(expected["parameters"]))
                self.assertEqual(library.json, expected)
                self.check_values(library, expected, np.column_stack([library.lower, library.upper]))
                inference = twinmap.Map.load(run).infer(measured, refine=refine)
                self.assertEqual(inference.details, expected)
                self.check_values(inference, expected, inference.interval)
                np.testing.assert_array_equal(inference.covariance, library.covariance)
                self.check_frame(inference, expected)
                by_estimator = expected.get("inverse_map", expected)["parameters"]
                if kind != "mixture":  # whose export is refused
                    self.check_c(run, measured, by_estimator, None if refine else inference.covariance)
                    self.check_fmu(run, measured, by_estimator)

    def check_intervals(self, kind, parameters):
        """That the kinds are what their names say."""
        for estimate in parameters.values():
            factors = [
                (estimate["mean"] - estimate["lower"]) / estimate["sd"],
                (estimate["upper"] - estimate["mean"]) / estimate["sd"],
            ]
            if kind not in ("mixture", "not normal", "posterior"):
                np.testing.assert_allclose(factors, 1.959963984540054, rtol=1e-9)
        if kind == "not normal":
            self.assertLess((parameters["k"]["upper"] - parameters["k"]["lower"]) / parameters["k"]["sd"], 3.8)
        if kind in ("mixture", "posterior"):
            self.assertEqual(len(parameters["e"]["intervals95"]), 2)

    def check_csv_and_text(self, table, text, expected):
        rows = list(csv.DictReader(io.StringIO(table)))
        self.assertEqual([row["parameter"] for row in rows], list(expected["parameters"]))
        for row, estimate in zip(rows, expected["parameters"].values()):
            self.assertEqual(
                [float(row[key]) for key in ("mean", "sd", "lower", "upper")],
                [estimate[key] for key in ("mean", "sd", "lower", "upper")],
            )
            self.assertEqual(row["method"], expected["method"])
            self.assertEqual(row["status"].split(), expected.get("statuses", []))
        for name, estimate in expected["parameters"].items():
            line = next(line for line in text.splitlines() if line.split()[:1] == [name])
            shown = np.array([float(number) for number in re.findall(r"(?<= )-?\d[\d.]*(?:e[+-]?\d+)?", line)])
            for value in [
                estimate["mean"],
                *np.ravel(estimate.get("intervals95", [estimate["lower"], estimate["upper"]])),
            ]:
                self.assertLess(np.min(np.abs(shown - value)), 1e-4 * estimate["sd"] + 6e-6 * abs(value), line)

    def check_values(self, found, expected, interval):
        estimates = expected["parameters"].values()
        np.testing.assert_array_equal(found.mean, [one["mean"] for one in estimates])
        np.testing.assert_array_equal(found.stddev, [one["sd"] for one in estimates])
        np.testing.assert_array_equal(interval, [[one["lower"], one["upper"]] for one in estimates])
        np.testing.assert_allclose(np.sqrt(np.diag(found.covariance)), found.stddev, rtol=1e-9)
        self.assertEqual(found.method, expected["method"])
        self.assertEqual(found.statuses, expected.get("statuses", []))

    def check_frame(self, inference, expected):
        frame = inference.to_frame()
        for name, estimate in expected["parameters"].items():
            self.assertEqual(
                list(frame.loc[name, ["mean", "stddev", "lower", "upper"]]),
                [estimate[key] for key in ("mean", "sd", "lower", "upper")],
            )

    def check_exported(self, found, estimate):
        for value, key in zip(found, ("mean", "sd", "lower", "upper")):
            self.assertAlmostEqual(value, estimate[key], delta=DIGITS * estimate["sd"])

    def check_c(self, run, measured, parameters, covariance):
        folder = measured.parent / "c"
        result = call("export", run, "--c", folder, "--no-trust")
        self.assertEqual(result.returncode, 0, result.stderr)
        (folder / "driver.c").write_text(DRIVER)
        compile_c(folder, ["driver.c", "twinmap_map.c"], "driver", "-march=native")
        samples = pd.read_csv(measured)
        rows = samples[samples.t > 0.04][["t", "y"]].to_numpy()
        self.assertEqual(len(rows), 40)
        text = "\n".join(f"{float(t)!r} {float(y)!r}" for t, y in rows)
        result = subprocess.run([folder / "driver"], input=text, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        found = np.array([[float(number) for number in line.split()] for line in result.stdout.splitlines()])
        for row, estimate in zip(found, parameters.values(), strict=True):
            self.check_exported(row, estimate)
        if covariance is not None:
            scale = np.sqrt(np.outer(np.diag(covariance), np.diag(covariance)))
            np.testing.assert_allclose(found[:, 4:] / scale, covariance / scale, atol=1e-5)

    def check_fmu(self, run, measured, parameters):
        file, folder = measured.parent / "map.fmu", measured.parent / "fmu"
        result = call("export", run, "--fmu", file, "--fmi", 2, "--no-trust")
        self.assertEqual(result.returncode, 0, result.stderr)
        with zipfile.ZipFile(file) as archive:
            archive.extractall(folder)
        root = ElementTree.parse(folder / "modelDescription.xml").getroot()
        references = {
            variable.get("name"): int(variable.get("valueReference")) for variable in root.find("ModelVariables")
        }
        (library,) = folder.glob("binaries/*/*.so")
        block = Block2(library, root)
        samples = pd.read_csv(measured)
        values = samples[samples.t > 0.04].y.to_numpy()
        for i in range(len(values) + 1):
            block.set([references["y"]], [values[min(i, len(values) - 1)]])
            block.step(0.05 * (i + 1), 0.05)
        self.assertEqual(block.get_integer(references["inferences"]), 1)
        for name, estimate in parameters.items():
            found = block.get([references[f"{key}.{name}"] for key in ("mean", "sd", "lower", "upper")])
            self.check_exported(found, estimate)
