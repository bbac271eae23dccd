"""Results in Python: the tables of a run's folder."""
import unittest
from pathlib import Path

import pandas as pd

import twinmap
from package_support import run_once


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        _, cls.results = run_once()

    def test_every_csv_file_is_a_table(self):
        self.assertEqual(self.results.list_tables(), sorted(f.stem for f in self.results.folder.glob("*.csv")))
        for name in self.results.list_tables():
            self.assertIsInstance(self.results.table(name), pd.DataFrame, name)
            self.assertIs(getattr(self.results, name), self.results.table(name))
            self.assertIn(name, dir(self.results))

    def test_metrics_are_indexed_by_the_parameter(self):
        metrics = self.results.metrics
        self.assertEqual(list(metrics.index), ["d_y", "d_theta", "k_y", "k_theta"])
        self.assertEqual(metrics.loc["k_y", "unit"], "N/m")
        errors = self.results.predictions.query("parameter == 'k_y'")
        relative = 100 * (errors.inferred - errors.true) / errors.true
        self.assertAlmostEqual(relative.mean(), metrics.loc["k_y", "bias_pct"], places=9)
        self.assertAlmostEqual(relative.std(), metrics.loc["k_y", "sd_pct"], places=9)

    def test_what_is_not_there_says_what_is(self):
        with self.assertRaisesRegex(AttributeError, "metrics"):
            self.results.posterior
        with self.assertRaisesRegex(KeyError, "metrics"):
            self.results.table("posterior")
        with self.assertRaisesRegex(FileNotFoundError, "metrics.csv"):
            twinmap.Results.load(Path("/"))

    def test_can_be_loaded_again(self):
        again = twinmap.Results.load(str(self.results.folder))
        pd.testing.assert_frame_equal(again.metrics, self.results.metrics)
        self.assertEqual([q.name for q in again.map.parameters], list(again.metrics.index))

    def test_tells_where_it_comes_from(self):
        self.assertEqual(self.results.provenance["version"], twinmap.__version__)
        self.assertIsInstance(self.results.warnings, list)
        self.assertIn("| k_theta", self.results.to_markdown())
        self.assertIn("metrics", repr(self.results))

    def test_a_notebook_shows_the_report(self):
        page = self.results._repr_html_()
        self.assertTrue(page.startswith("<iframe srcdoc="))
        quoted = page.split('"')[1]  # nothing of the page ends the attribute
        self.assertGreater(len(quoted), 500000)
        self.assertIn("&lt;html", quoted[:1000])
