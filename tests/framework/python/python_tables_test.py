"""The package without pandas: small tables that hold what DataFrames hold."""
import json
import subprocess
import sys
import unittest

import numpy as np
import pandas as pd

from package_support import TABLE_1, FolderTestCase
from twinmap._tables import Table

WITHOUT = """
import json, sys
sys.modules["pandas"] = None
import twinmap
experiment = twinmap.Experiment.from_file(sys.argv[1]).override({"design.train.samples": 60, "evaluation.limit": False})
results = experiment.run(sys.argv[2])
table = results.metrics[["unit", "sd_pct"]].round(4)
machine = experiment.simulate({"k_y": 8}, noise=True, seed=2).to_frame()
estimate = results.map.infer(machine)
print(json.dumps([table.index, list(table["unit"]), list(table["sd_pct"]), estimate["k_y"], list(estimate.to_frame()["mean"])]))
repr(table), repr(estimate), estimate._repr_html_(), repr(results.predictions)
"""


class Tables(FolderTestCase):
    def test_the_package_needs_numpy_alone(self):
        folder = self.folder / "run"
        said = subprocess.run(
            [sys.executable, "-c", WITHOUT, TABLE_1, folder], capture_output=True, text=True, timeout=600
        )
        self.assertEqual(said.returncode, 0, said.stderr)
        index, units, sds, k_y, means = json.loads(said.stdout)
        metrics = pd.read_csv(folder / "metrics.csv").set_index("parameter")
        self.assertEqual(index, list(metrics.index))
        self.assertEqual(units, list(metrics["unit"]))
        self.assertEqual(sds, list(metrics["sd_pct"].round(4)))
        self.assertEqual(k_y[0], means[index.index("k_y")])

    def test_a_table_has_rows_and_columns(self):
        table = Table({"unit": ["m", "s"], "sd": [0.12345, 2.0]}, ["x", "t"], "parameter")
        self.assertEqual((table.columns, table.index), (["unit", "sd"], ["x", "t"]))
        self.assertEqual(table.loc["t", "sd"], 2.0)
        np.testing.assert_array_equal(table[["sd"]].round(2)["sd"], [0.12, 2.0])
        self.assertEqual(repr(table).split(), ["parameter", "unit", "sd", "x", "m", "0.12345", "t", "s", "2"])
        self.assertEqual(dict(table)["unit"][1], "s")

    def test_what_is_written_is_read(self):
        table = Table({"t": [0.0, 0.1], "y": [1 / 3, np.nan]})
        table.to_csv(self.folder / "m.csv", index=False)
        read = pd.read_csv(self.folder / "m.csv", float_precision="round_trip")
        np.testing.assert_array_equal(read["y"], table["y"])
        np.testing.assert_array_equal(read["t"], table["t"])


if __name__ == "__main__":
    unittest.main()
