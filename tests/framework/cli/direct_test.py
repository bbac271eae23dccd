"""Inference from an experiment file alone: no run, no map."""
import json
import re
import shlex
import unittest

import numpy as np
import yaml

from support import EXPERIMENTS, MIRROR, FolderTestCase, call, read_csv, write_csv

CART = EXPERIMENTS / "duffing/cart.yaml"
TRUE = {"k": 95.0, "d": 1.2, "k3": 2500.0}
POINT = [f"parameters.{name}={value}" for name, value in TRUE.items()]
# With so much noise they count.
PRIORS = [
    "parameters.k.prior={normal: {mean: 95, stddev: 1}}",
    "parameters.d.prior={lognormal: {median: 1.1, factor: 1.15}}",
    "priors=[{correlated: {names: [k, d], correlation: -0.5}}]",
    "noise.scale=20",
]
ESTIMATORS = {
    "gp": "gp",
    "surrogate": "surrogate",
    "network": "{network: {surrogate_samples: 4000, steps: 400, hidden: [16]}}",
}


class Direct(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.measured = cls.simulate(CART, "measured.csv", *POINT)

    @classmethod
    def simulate(cls, experiment, name, *overrides):
        path = cls.folder / name
        result = call("simulate", experiment, "--noise", "--csv", path, *overrides)
        assert result.returncode == 0, result.stderr
        return path

    def infer(self, *arguments):
        result = call("infer", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_finds_the_parameters_without_a_run(self):
        found = json.loads(self.infer(CART, self.measured, "--json"))
        self.assertEqual((found["status"], found["method"]), ("ok", "posterior"))
        covariance = np.array(found["covariance"])
        for i, (name, true) in enumerate(TRUE.items()):
            estimate = found["parameters"][name]
            self.assertLess(abs(estimate["mean"] - true), 4 * estimate["sd"], name)
            self.assertTrue(estimate["lower"] < estimate["mean"] < estimate["upper"])
            self.assertAlmostEqual(covariance[i, i] ** 0.5 / estimate["sd"], 1)
        self.assertGreater(found["posterior"]["effective_sample_size"], 100)

    def test_says_where_an_unstable_model_grows_and_which_sign_to_look_at(self):
        """A spring and a damper that push, each named by its place."""
        for section, key in (("springs", "stiffness"), ("dampers", "damping")):
            with self.subTest(section):
                experiment = yaml.safe_load(CART.read_text())
                element = experiment["system"][section][0]
                element[key] = f"-({element[key]})"
                wrong = self.folder / f"wrong_{section}.yaml"
                wrong.write_text(yaml.safe_dump(experiment))
                result = call("infer", wrong, self.measured)
                self.assertRegex(
                    result.stdout + result.stderr,
                    rf"the model is unstable about its equilibrium: x grows e-fold in [0-9.]+ s, as a force rises "
                    rf"with .*the sign of .*wrong_{section}.yaml:\d+:\d+: system.{section}\[0\].{key}",
                )
                self.assertNotRegex(result.stderr, r"by up to [0-9.]+e\+")

    def test_names_masses_in_g(self):
        """Of one body, and of a body among two."""
        chain = {
            "name": "chain",
            "parameters": {"k": {"bounds": [80, 120], "unit": "N/m"}, "c": {"bounds": [40, 60], "unit": "N/m"}},
            "system": {
                "bodies": {
                    "cart": {"mass": 1.2, "joint": {"type": "slider", "coordinates": ["x"]}},
                    "rider": {"mass": 0.4, "joint": {"type": "slider", "parent": "cart", "coordinates": ["y"]}},
                },
                "springs": [{"coordinate": "x", "stiffness": "k"}, {"coordinate": "y", "stiffness": "c"}],
                "dampers": [{"coordinate": "x", "damping": 1}, {"coordinate": "y", "damping": 0.5}],
            },
            "initial": {"coordinates": {"x": 0.05}},
            "outputs": {"x": {"coordinate": "x"}, "y": {"coordinate": "y"}},
            "simulation": {"duration": 3},
            "features": [{"samples": {"outputs": ["x", "y"], "start": 0.05, "interval": 0.05, "count": 60}}],
            "noise": {"stddev": {"x": 1e-4, "y": 1e-4}},
        }
        for experiment, body in ((yaml.safe_load(CART.read_text()), "cart"), (chain, "rider")):
            with self.subTest(body):
                file = self.folder / "heavy.yaml"
                file.write_text(yaml.safe_dump(experiment))
                measured = self.simulate(file, "heavy.csv")
                self.assertNotIn("in the place of kg", self.infer(file, measured))
                experiment["system"]["bodies"][body]["mass"] *= 1000
                file.write_text(yaml.safe_dump(experiment))
                self.assertIn(f"the mass of {body} is 1000 times too large", self.infer(file, measured))

    def test_asks_whether_an_angle_of_more_than_a_turn_is_in_degrees(self):
        experiment = yaml.safe_load(CART.read_text())
        law = experiment["system"]["force_laws"][0]
        for call_text in ("sin(30)", "cos(45.5)"):
            with self.subTest(call_text):
                tilted = self.folder / "tilted.yaml"
                changed = json.loads(json.dumps(experiment))
                changed["system"]["force_laws"][0]["force"] = f"{law['force']} - 9.81 * {call_text}"
                tilted.write_text(yaml.safe_dump(changed))
                says = f"{call_text[:-1]}*pi/180)"
                self.assertIn(says, call("check", tilted).stdout)
                self.assertIn(says, call("infer", tilted, self.measured).stdout)
        self.assertNotIn("pi/180", call("check", CART).stdout)

    def test_says_of_a_force_that_jumps_what_to_write(self):
        experiment = yaml.safe_load(CART.read_text())
        laws = experiment["system"].setdefault("force_laws", [])
        for sign in ("-40*sign(x_dot)", "-40*sign(x)"):
            with self.subTest(sign):
                jumps = self.folder / "jumps.yaml"
                changed = json.loads(json.dumps(experiment))
                changed["system"]["force_laws"] = [*laws, {"coordinate": "x", "force": sign}]
                jumps.write_text(yaml.safe_dump(changed))
                result = call("infer", jumps, self.measured)
                self.assertIn(f"{sign[4:]} jumps: ", result.stdout)

    def test_leaves_missing_samples_out_and_says_so(self):
        lines = self.measured.read_text().splitlines()
        rows = [line.split(",") for line in lines[1:]]
        for i in range(5, len(rows), 10):
            rows[i][1] = ["", "nan", "NA"][i % 3]
        rows[40], rows[60] = rows[60], rows[40]
        damaged = self.folder / "damaged.csv"
        damaged.write_text("\n".join([lines[0]] + [",".join(row) for row in rows]) + "\n")
        whole = json.loads(self.infer(CART, self.measured, "--json"))
        found = json.loads(self.infer(CART, damaged, "--json"))
        self.assertEqual(found["status"], "ok")
        self.assertIn("samples of", found["left_out"][-1])
        for name, true in TRUE.items():
            estimate = found["parameters"][name]
            self.assertLess(abs(estimate["mean"] - true), 4 * estimate["sd"], name)
            self.assertLess(estimate["sd"], 1.25 * whole["parameters"][name]["sd"])
        self.assertIn("left out:", self.infer(CART, damaged))

    def change(self, name, change):
        """The measurement with the numbers of its first output changed."""
        lines = self.measured.read_text().splitlines()
        rows = [line.split(",") for line in lines[1:]]
        for i, row in enumerate(rows):
            row[1] = repr(change(i, float(row[1])))
        path = self.folder / name
        path.write_text("\n".join([lines[0]] + [",".join(row) for row in rows]) + "\n")
        return path

    def test_spikes_are_named_and_left_out(self):
        spiked = self.change("spiked.csv", lambda i, x: x + (0.5 if i in (31, 64) else 0.0))
        found = json.loads(self.infer(CART, spiked, "--json"))
        self.assertEqual(found["statuses"], ["outliers"])
        self.assertEqual(len(found["outliers"]), 2)
        for name, true in TRUE.items():
            estimate = found["parameters"][name]
            self.assertLess(abs(estimate["mean"] - true), 4 * estimate["sd"], name)
        self.assertIn("2 samples are not noise and left out", self.infer(CART, spiked))

    def test_features_between_samples_are_moved_to_these(self):
        between = "features=[{samples: {outputs: [x], start: 0.03, interval: 0.05, count: 100}}]"
        shifted = self.simulate(CART, "shifted.csv", between, *POINT)
        found = json.loads(self.infer(CART, shifted, "--json"))
        self.assertEqual(found["statuses"], ["ok"])
        self.assertIn("at the times of the recording", found["remarks"][0])
        self.expect_true(found)
        whole = json.loads(self.infer(CART, self.measured, "--json"))
        for name in TRUE:
            self.assertLess(found["parameters"][name]["sd"], 1.1 * whole["parameters"][name]["sd"])

    def test_spikes_in_noise_that_is_unknown_are_left_out(self):
        path = self.folder / "unknown_spikes.yaml"
        path.write_text(CART.read_text().replace("stddev: {x: 1e-4}", "stddev: {x: unknown}"))
        spiked = self.change("spiked_unknown.csv", lambda i, x: x + (0.03 if i in (31, 64) else 0.0))
        found = json.loads(self.infer(path, spiked, "--json"))
        self.assertEqual(found["statuses"], ["outliers"])
        self.assertEqual(len(found["outliers"]), 2)
        self.assertAlmostEqual(found["noise"]["x"]["stddev"], 1e-4, delta=3e-5)
        self.expect_true(found)

    def test_spikes_and_larger_noise_are_found_together(self):
        self.simulate(CART, "louder.csv", "noise.scale=3", *POINT)
        louder = self.folder / "louder.csv"
        rows = [line.split(",") for line in louder.read_text().splitlines()]
        for i in (30, 63):
            rows[i][1] = repr(float(rows[i][1]) + 0.05)
        louder.write_text("\n".join(",".join(row) for row in rows) + "\n")
        found = json.loads(self.infer(CART, louder, "--json"))
        self.assertEqual(found["statuses"], ["outliers", "noise_larger"])
        self.assertEqual(len(found["outliers"]), 2)
        self.expect_true(found)

    def restamp(self, name, change):
        """The measurement by another clock."""
        header, *rows = (line.split(",") for line in self.measured.read_text().splitlines())
        lines = [header] + [[repr(change(float(row[0]))), *row[1:]] for row in rows]
        path = self.folder / name
        path.write_text("\n".join(map(",".join, lines)) + "\n")
        return path

    def test_a_clock_that_slips_is_named_and_does_not_count(self):
        slipped = self.restamp("slipped.csv", lambda t: t + (0.01 if t > 2.0 else 0.0))
        found = json.loads(self.infer(CART, slipped, "--json"))
        self.assertEqual(found["statuses"], ["clock_fault"])
        (slip,) = found["clock"]
        self.assertLess(abs(slip["late"] - 0.01), 4 * slip["sd"])
        self.assertAlmostEqual(slip["from"], 2.06, delta=0.11)
        self.expect_true(found)
        self.assertRegex(self.infer(CART, slipped), r"from t = 2.06 s on the record is [0-9.]+ ms late")

    def test_a_clock_that_is_late_is_named(self):
        """By more than two samples, so that the last ones come after the simulation's end."""
        first, second = (float(row.split(",")[0]) for row in self.measured.read_text().splitlines()[1:3])
        late = 2.3 * (second - first)
        moved = self.restamp("late.csv", lambda t: t - late)
        found = json.loads(self.infer(CART, moved, "--json"))
        self.assertEqual(found["statuses"], ["clock_fault"])
        (clock,) = found["clock"]
        self.assertLess(abs(clock["late"] + late), 4 * clock["sd"])
        self.expect_true(found)

    def test_a_clock_that_runs_fast_is_named(self):
        fast = self.restamp("fast.csv", lambda t: 1.004 * t)
        found = json.loads(self.infer(CART, fast, "--json"))
        self.assertEqual(found["statuses"], ["clock_fault"])
        (rate,) = found["clock"]
        self.assertLess(abs(rate["rate"] - 0.004 / 1.004), 4 * rate["sd"])
        self.expect_true(found)

    def test_noise_of_another_size_is_found(self):
        noisy = self.simulate(CART, "noisy.csv", "noise.scale=3", *POINT)
        found = json.loads(self.infer(CART, noisy, "--json"))
        self.assertEqual(found["statuses"], ["noise_larger"])
        self.assertAlmostEqual(found["noise_factor"], 3, delta=0.6)
        stated = json.loads(self.infer(CART, self.measured, "--json"))
        for name, true in TRUE.items():
            estimate = found["parameters"][name]
            self.assertLess(abs(estimate["mean"] - true), 4 * estimate["sd"], name)
            self.assertGreater(estimate["sd"], 2 * stated["parameters"][name]["sd"])

    def expect_true(self, found):
        for name, true in TRUE.items():
            estimate = found["parameters"][name]
            self.assertLess(abs(estimate["mean"] - true), 4 * estimate["sd"], name)

    def test_coloured_noise_is_named_and_widens_the_intervals(self):
        coloured = "noise.correlation={x: {autoregression: [0.8]}}"
        noisy = self.simulate(CART, "coloured.csv", coloured, *POINT)
        found = json.loads(self.infer(CART, noisy, "--json"))
        self.assertEqual(found["statuses"], ["noise_coloured"])
        self.expect_true(found)
        self.assertIn("autoregression", found["noise"]["x"])
        stated = json.loads(self.infer(CART, self.measured, "--json"))
        ratios = [found["parameters"][n]["sd"] / stated["parameters"][n]["sd"] for n in TRUE]
        self.assertGreater(max(ratios), 1.2)
        self.assertIn("noise_coloured: the noise of x is coloured", self.infer(CART, noisy))

    def test_coloured_noise_is_not_taken_for_an_offset(self):
        coloured = "noise.correlation={x: {autoregression: [0.5]}}"
        noisy = self.simulate(CART, "wandering.csv", coloured, "seed=106", *POINT)
        found = json.loads(self.infer(CART, noisy, "--json"))
        self.assertEqual(found["statuses"], ["noise_coloured"])
        self.expect_true(found)

    def test_an_offset_of_a_sensor_is_found(self):
        found = json.loads(self.infer(CART, self.change("offset.csv", lambda i, x: x + 5e-4), "--json"))
        self.assertEqual(found["statuses"], ["sensor_offset"])
        self.expect_true(found)
        noise = found["noise"]["x"]
        self.assertLess(abs(noise["offset"] - 5e-4), 4 * noise["offset_stddev"])

    def test_noise_that_is_unknown_is_inferred(self):
        path = self.folder / "unknown.yaml"
        path.write_text(CART.read_text().replace("stddev: {x: 1e-4}", "stddev: {x: unknown}"))
        found = json.loads(self.infer(path, self.measured, "--json"))
        self.assertEqual(found["statuses"], ["ok"])
        self.expect_true(found)
        self.assertAlmostEqual(found["noise"]["x"]["stddev"], 1e-4, delta=3e-5)
        refused = call("run", path)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("noise.stddev.x: 'unknown' is for `twinmap infer FILE.yaml", refused.stderr)

    def test_clipped_samples_say_that_the_response_is_beyond(self):
        values = [float(line.split(",")[1]) for line in self.measured.read_text().splitlines()[1:]]
        limit = 0.8 * max(abs(value) for value in values)
        clipped = self.change("clipped.csv", lambda i, x: max(-limit, min(limit, x)))
        path = self.folder / "clips.yaml"
        path.write_text(CART.read_text() + f"\nmeasurement: {{range: {{x: [{-limit!r}, {limit!r}]}}}}\n")
        found = json.loads(self.infer(path, clipped, "--json"))
        self.assertEqual(found["statuses"], ["ok"])
        self.expect_true(found)
        self.assertIn("at a limit of its range", found["left_out"][0])

    def infer_json(self):
        return json.loads(self.infer(CART, self.measured, "--json"))

    def stdout(self, *arguments):
        result = call(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_page_of_one_measurement_draws_what_is_measured_over_what_is_fitted(self):
        """Of a sound recording, of one that lacks samples and of a model that does not fit."""
        lines = self.measured.read_text().splitlines()
        lacking = self.folder / "lacking.csv"
        lacking.write_text("\n".join(lines[:30] + lines[40:]) + "\n")
        for name, files, says in (
            ("sound", [self.measured], "measured.csv: ok"),
            ("lacking", [lacking], "lacking.csv: ok"),
            ("light", [self.simulate(CART, "light.csv", "system.bodies.cart.mass=0.9")], "model_mismatch"),
        ):
            with self.subTest(name):
                page = self.folder / f"{name}.html"
                self.infer(CART, *files, "--page", page)
                text = page.read_text()
                self.assertIn(says, text)
                for part in (
                    "x: measured, nominal, updated",
                    "spectrum of the residual",
                    "Estimates within their bounds",
                ):
                    self.assertIn(part, text)
        page = self.folder / "two.html"
        self.infer(CART, self.measured, lacking, "--page", page)
        text = page.read_text()
        self.assertIn("Parameters over the measurements", text)
        self.assertIn("lacking.csv: Responses", text)

    def test_replay_takes_an_experiment_file(self):
        out = self.folder / "replayed"
        result = call("replay", CART, self.measured, "--out", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("measured.csv: ok", result.stdout)
        rows = read_csv(out / "replay.csv")
        self.assertEqual(len(rows), 100)
        residual = np.array([float(row["measured"]) - float(row["updated"]) for row in rows]) / 1e-4
        self.assertLess(abs(np.sqrt((residual**2).mean()) - 1), 0.25)
        other = self.simulate(CART, "other.csv", *POINT, "seed=5")
        result = call("replay", CART, other, "--from", self.measured, "--out", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        refused = call("replay", CART, self.measured, "--refine", "--out", out)
        self.assertIn("inferred by simulation alone", refused.stderr)

    def test_prints_nuisance_parameters_with_their_sds(self):
        experiment = yaml.safe_load(CART.read_text())
        experiment["nuisance"] = {"x0": {"bounds": [-0.1, 0.1], "unit": "m"}}
        experiment["initial"] = {"coordinates": {"x": "x0"}}
        released = self.folder / "released.yaml"
        released.write_text(yaml.safe_dump(experiment))
        for start in (0.05, -0.02):
            with self.subTest(start):
                measured = self.simulate(released, "released.csv", *POINT, f"nuisance.x0={start}")
                found = json.loads(self.infer(released, measured, "--json"))["nuisance"]["x0"]
                self.assertLess(abs(found["mean"] - start), 4 * found["sd"])
                self.assertLess(found["sd"], 1e-3)
                self.assertIn("x0 (nuisance)", self.infer(released, measured))

    def test_changes_over_measurements_are_named_and_drawn(self):
        files = [
            self.simulate(CART, f"in_order_{i}.csv", *POINT, f"seed={i}", f"parameters.k={95 if i < 4 else 94.5}")
            for i in range(8)
        ]
        page = self.folder / "over_time.html"
        text = self.infer(CART, *files, "--page", page)
        courses = text[text.index("Over 8 of 8 measurements") :]
        self.assertRegex(courses, r"\n  k fell by 0\.[45]\d* N/m \(0\.5\d? %, sd 0\.0\d+\) at once, at measurement 5\n")
        self.assertRegex(courses, r"\n  d is constant, 1\.[12]\d* N s/m \(sd ")
        self.assertIn("k fell by", page.read_text())
        refused = call("infer", CART, *files, "--joint", "--page", page)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--page draws estimates of one measurement after another", refused.stderr)

    def read_page(self, *arguments):
        """Tables of figures, by name."""
        page = self.folder / "page.html"
        self.infer(*arguments, "--page", page)
        data = re.search(r'id="page-data">(.*?)</script>', page.read_text(), re.DOTALL).group(1)
        return json.loads(data)["tables"]

    def test_page_has_derived_quantities(self):
        derived, page = self.folder / "derived_page.yaml", self.folder / "derived_page.html"
        derived.write_text(CART.read_text() + "derived: {k_per_d: {value: k / d, unit: 1/s}}\n")
        found = json.loads(self.infer(derived, self.measured, "--page", page, "--json"))["derived"]["k_per_d"]
        rows = page.read_text().split('aria-label="What is determined besides')[1].split("</table>")[0]
        self.assertRegex(rows, rf"k_per_d</td>.*{found['mean']}.*{found['sd']}")

    def test_page_of_one_recording_draws_measured_over_fitted(self):
        lines = self.measured.read_text().splitlines()
        holed = self.folder / "holed.csv"
        holed.write_text("\n".join(lines[:40] + lines[60:]) + "\n")
        tables = self.read_page(CART, holed)
        self.assertNotIn("history", tables)  # one dot a parameter would say nothing
        drawn = tables["replay-0"]
        measured = np.array(drawn["measured"], dtype=float)
        gone = [float(line.split(",")[0]) for line in lines[40:60]]
        expected = [min(abs(time - t) for t in gone) < 1e-6 for time in drawn["time"]]
        np.testing.assert_array_equal(np.isnan(measured), expected)
        found = json.loads(self.infer(CART, holed, "--json"))["parameters"]
        clean = self.folder / "clean.csv"
        values = [f"parameters.{name}={one['mean']!r}" for name, one in found.items()]
        self.assertEqual(call("simulate", CART, "--csv", clean, *values).returncode, 0)
        fitted = np.loadtxt(clean, delimiter=",", skiprows=1)
        expected = np.interp(drawn["time"], fitted[:, 0], fitted[:, 1])
        np.testing.assert_allclose(drawn["updated"], expected, atol=2e-4)  # the best fit is not the mean: .2 noise sds
        self.assertEqual(len(tables["spectrum-0"]["power"]), len(measured[~np.isnan(measured)]) // 2)
        self.assertEqual(tables["intervals"]["parameter"], ["k [N/m]", "d [N s/m]", "k3 [N/m^3]"])

    def test_nuisance_parameters_have_estimates(self):
        experiment = EXPERIMENTS / "mechanisms/released_pendulum.yaml"
        true = {"start_x": 0.004, "start_angle": 0.9, "start_rate": 0.1}
        file = self.simulate(experiment, "released.csv", *(f"nuisance.{name}={value}" for name, value in true.items()))
        found = json.loads(self.infer(experiment, file, "--json"))["nuisance"]
        for name, value in true.items():
            self.assertLess(abs(found[name]["mean"] - value), 4 * found[name]["sd"], name)
            self.assertTrue(found[name]["lower"] < found[name]["mean"] < found[name]["upper"], name)
        self.assertIn("start_angle (nuisance)", self.infer(experiment, file))
        tables = self.read_page(experiment, file, file)
        self.assertIn("history", tables)
        self.assertIn("m2-replay-1", tables)  # the second output of the second recording

    def test_table_and_csv_say_the_same(self):
        found = json.loads(self.infer(CART, self.measured, "--json"))
        table = self.infer(CART, self.measured)
        self.assertIn("measured.csv: ok (chi-square ", table)
        self.assertIn("\n  sampled on the simulator\n", table)  # nothing limits it
        path = self.folder / "found.csv"
        path.write_text(self.infer(CART, self.measured, "--csv"))
        for row in read_csv(path):
            estimate = found["parameters"][row["parameter"]]
            for column, key in (("mean", "mean"), ("sd", "sd"), ("lower", "lower"), ("upper", "upper")):
                self.assertEqual(float(row[column]), estimate[key])
            self.assertEqual((row["status"], row["method"]), ("ok", "posterior"))

    def test_draws_have_the_moments_that_are_printed(self):
        draws = self.folder / "draws.csv"
        found = json.loads(self.infer(CART, self.measured, "--json", "--posterior=1000", "--draws", draws))
        rows = read_csv(draws)
        weights = np.array([float(row["weight"]) for row in rows])
        self.assertGreaterEqual(len(rows), 1000)
        for name in TRUE:
            values = np.array([float(row[name]) for row in rows])
            self.assertAlmostEqual(weights @ values / found["parameters"][name]["mean"], 1, places=9)

    def test_both_signs_that_fit_are_named(self):
        path = self.folder / "mirror.yaml"
        path.write_text(MIRROR)
        measured = self.simulate(path, "mirror.csv", "parameters.e=0.05", "parameters.k=4")
        found = json.loads(self.infer(path, measured, "--json"))
        self.assertEqual(found["status"], "multimodal")
        modes = sorted(mode["parameters"]["e"]["mean"] for mode in found["components"])
        self.assertEqual(len(modes), 2)
        for mode, true in zip(modes, (-0.05, 0.05)):
            self.assertAlmostEqual(mode, true, delta=0.01)
        for mode in found["components"]:
            self.assertAlmostEqual(mode["weight"], 0.5, delta=0.1)
        self.assertIn("multimodal, several parameter values may fit", self.infer(path, measured))
        (self.folder / "mirror_found.csv").write_text(self.infer(path, measured, "--csv"))
        row = read_csv(self.folder / "mirror_found.csv")[0]
        self.assertEqual(row["status"], "multimodal")
        self.assertEqual(
            [float(part.split(":")[0]) for part in row["components"].split("; ")],
            [mode["weight"] for mode in found["components"]],
        )

    def test_a_run_names_both_signs_too(self):
        path = self.folder / "mirror_run.yaml"
        path.write_text(MIRROR)
        measured = self.simulate(path, "mirror_run.csv", "parameters.e=0.05", "parameters.k=4")
        run = self.folder / "mirror_run"
        result = call(
            "run", path, "design.train.samples=60", "design.test.samples=60", "evaluation.limit=false", "--out", run
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        found = json.loads(self.infer(run, measured, "--json"))
        self.assertEqual((found["status"], found["method"]), ("multimodal", "posterior"))
        modes = sorted(mode["parameters"]["e"]["mean"] for mode in found["components"])
        for mode, true in zip(modes, (-0.05, 0.05)):
            self.assertAlmostEqual(mode, true, delta=0.01)
        self.assertEqual(found["parameters"], found["posterior"]["parameters"])
        self.assertIn("parameters", found["inverse_map"])

    def test_a_unit_is_named_as_the_cause(self):
        scaled = self.change("scaled.csv", lambda i, x: 1000 * x)
        found = json.loads(self.infer(CART, scaled, "--json"))
        self.assertEqual(found["status"], "model_mismatch")
        self.assertEqual(found["fault"], "x is 1000 times too large, as mm in the place of m: divide it by 1000")
        text = self.infer(CART, scaled)
        self.assertIn(found["fault"], text)
        self.assertNotIn("Take more draws", text)

    def test_bounds_that_exclude_the_machine_are_named(self):
        """Of a drop in water: the terminal speed is m g / c, the time constant m / c."""
        sinker = {
            "name": "sinker",
            "parameters": {"m": {"bounds": [1, 4], "unit": "kg"}, "c": {"bounds": [0.5, 20], "unit": "N s/m"}},
            "system": {
                "bodies": {"ball": {"mass": "m", "joint": {"type": "slider", "coordinates": ["z"]}}},
                "dampers": [{"coordinate": "z", "damping": "c"}],
                "force_laws": [{"coordinate": "z", "force": "30"}],
            },
            "outputs": {"z": {"coordinate": "z"}},
            "simulation": {"duration": 5},
            "features": [{"samples": {"outputs": ["z"], "start": 0.1, "interval": 0.1, "count": 49}}],
            "noise": {"stddev": {"z": 1e-3}},
        }
        file, record = self.folder / "sinker.yaml", self.folder / "sinker.csv"
        file.write_text(yaml.safe_dump(sinker))
        time = np.arange(0, 5.01, 0.05)
        mass, damping = 6.0, 3.0
        fallen = 30 / damping * (time - mass / damping * (1 - np.exp(-damping / mass * time)))
        write_csv(record, ["time", "z"], [time, fallen + 1e-3 * np.random.default_rng(1).normal(size=time.size)])
        found = json.loads(self.infer(file, record, "--json"))
        self.assertEqual(found["statuses"], ["model_mismatch", "at_bounds"])
        named = re.fullmatch(
            r"m fits at ([0-9.]+) kg \(bounds 1 .. 4\): widen these bounds, if that may be", found["fault"]
        )
        self.assertAlmostEqual(float(named.group(1)), mass, delta=0.02)

    def test_another_machine_is_a_mismatch(self):
        rows = read_csv(self.measured)
        names = list(rows[0])
        columns = [[float(row[name]) for row in rows] for name in names]
        wrong = self.folder / "wrong.csv"
        x = names.index("x")
        columns[x] = list(np.roll(columns[x], 7))
        write_csv(wrong, names, columns)
        found = json.loads(self.infer(CART, wrong, "--json"))
        self.assertEqual(found["status"], "model_mismatch")
        self.assertLess(found["trust"]["p_value"], 1e-6)
        table = self.infer(CART, wrong, "--start", 0)
        self.assertIn("no parameter values within the bounds fit, the largest misfit", table)
        command = re.search(r"Ask what the model lacks: twinmap (diagnose .*)", table).group(1)
        self.assertEqual(shlex.split(command), ["diagnose", str(CART), str(wrong), "--start", "0"])

    def test_residuals_that_are_not_independent_are_called_so(self):
        clean = self.folder / "clean.csv"
        self.assertEqual(call("simulate", CART, "--csv", clean, *POINT).returncode, 0)
        rows = read_csv(clean)
        times, x = ([float(row[name]) for row in rows] for name in ("t", "x"))
        unknown = self.folder / "unknown noise.yaml"
        unknown.write_text(CART.read_text().replace("{x: 1e-4}", "{x: unknown}"))
        for turn, words in ((2.0, "that are 3 samples apart are alike"), (2.9, "alternate (correlation -0.9")):
            swinging = self.folder / "swinging.csv"
            write_csv(swinging, ["t", "x"], [times, np.array(x) + 1.4e-4 * np.sin(turn * np.arange(len(x)))])
            for experiment in (CART, unknown):
                table = self.infer(experiment, swinging)
                self.assertIn("model_mismatch: the model does not explain the measurement: ", table)
                self.assertIn(words, table)
                self.assertNotIn("within the bounds fit", table)  # chi-square is that of noise
        self.assertIn(f"twinmap diagnose '{unknown}' {swinging}\n", table)

    def test_a_run_without_a_map_answers_as_its_file(self):
        run = self.folder / "run"
        result = call("run", CART, "inverse_map=none", "design.test.samples=40", "--out", run)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertFalse((run / "maps.h5").exists())
        self.assertTrue((run / "report.html").exists())
        for row in read_csv(run / "metrics.csv"):
            self.assertGreater(float(row["coverage95"]), 0.8)  # 40 samples: two of 10000 are below by chance
            self.assertTrue(0.6 < float(row["ratio_to_limit"]) < 1.6, row)  # errors of 11 to 16 %
        methods = read_csv(run / "methods.csv")
        self.assertEqual({row["method"] for row in methods}, {"posterior"})
        self.assertEqual(json.loads(self.infer(run, self.measured, "--json")), self.infer_json())
        self.assertEqual(call("verify", run).returncode, 0)
        self.assertIn("posterior on the simulator", self.stdout("check", run / "resolved.yaml"))
        result = call("infer", run, self.measured, "--refine")
        self.assertEqual(result.returncode, 2)
        result = call("run", CART, "inverse_map=none", "evaluation.baselines=[prior_mean]", "--out", run)
        self.assertEqual(result.returncode, 2)
        self.assertIn("every test sample is answered by its exact posterior", result.stderr)

    def test_a_run_without_a_map_takes_priors(self):
        run = self.folder / "priors"
        chosen = ["inverse_map=none", "design.test.samples=60", "evaluation.calibration=sbc"]
        result = call("run", CART, *PRIORS, *chosen, "--out", run)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = read_csv(run / "predictions.csv")
        truth = [np.array([float(row["true"]) for row in rows if row["parameter"] == name]) for name in TRUE]
        correlation = np.corrcoef(truth[0], np.log(truth[1]))[0, 1]
        self.assertTrue(94.3 < truth[0].mean() < 95.7 and 0.6 < truth[0].std() < 1.4)  # errors of .13 and .09
        self.assertTrue(-0.8 < correlation < -0.1, correlation)
        for row in read_csv(run / "metrics.csv"):
            self.assertGreater(float(row["coverage95"]), 0.85)
            self.assertTrue(0.6 < float(row["ratio_to_limit"]) < 1.4, row)
        limits = [float(row["limit_stddev"]) for row in rows if row["parameter"] == "k"]
        self.assertLess(max(limits), 1.0)  # the prior counts: less than its own standard deviation is left
        ranks = read_csv(run / "sbc.csv")
        self.assertEqual([row["quantity"] for row in ranks[::10]], [*TRUE, "joint"])
        for row in ranks:
            self.assertGreater(float(row["p_value"]), 1e-4, row)
        self.assertEqual(call("verify", run).returncode, 0)

    def test_estimators_learn_priors(self):
        for name, kind in ESTIMATORS.items():
            run = self.folder / f"prior {name}"
            chosen = ["design.test.samples=200", "evaluation.baselines=[prior_mean]", f"inverse_map={kind}"]
            calibration = ["evaluation.calibration=sbc"] if name == "surrogate" else []
            result = call("run", CART, *PRIORS, *chosen, *calibration, "--out", run)
            self.assertEqual(result.returncode, 0, result.stderr)
            for row in read_csv(run / "metrics.csv"):
                with self.subTest(estimator=name, parameter=row["parameter"]):
                    self.assertGreater(float(row["coverage95"]), 0.9)
                    self.assertTrue(0.8 < float(row["ratio_to_limit"]) < 1.3, row)
            before = [row for row in read_csv(run / "baselines.csv") if row["method"] == "prior_mean"]
            self.assertTrue(all(float(row["coverage95"]) > 0.9 for row in before), before)
            self.assertIn("  prior: k normal 95 +- 1", self.stdout("infer", run, self.measured))
            if name == "surrogate":
                self.assertTrue(all(float(row["p_value"]) > 1e-4 for row in read_csv(run / "sbc.csv")))
                self.assertEqual(call("verify", run).returncode, 0)

    def test_without_a_map_sweeps_and_plans_work(self):
        sweep = self.folder / "sweep"
        overrides = ["inverse_map=none", "design.test.samples=10", "noise.scale=1,2"]
        self.assertIn("nothing is trained", self.stdout("plan", CART, *overrides, "--out", sweep))
        result = call("run", CART, *overrides, "--out", sweep)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(list((sweep / "cases").iterdir())), 2)

    def test_coarse_tolerances_are_named_and_automatic_ones_follow_the_noise(self):
        low = ["noise.scale=1e-4", "--noise", "--csv", self.folder / "low.csv"]
        result = call("simulate", CART, *low)
        self.assertIn("integration tolerances tightened to ", result.stderr)
        self.assertNotIn("warning", result.stderr)
        path = self.folder / "coarse.yaml"
        path.write_text(CART.read_text().replace("{duration: 5}", "{duration: 5, relative_tolerance: 1e-3}"))
        result = call("simulate", path, "--csv", self.folder / "coarse.csv")
        line = next(i for i, text in enumerate(path.read_text().splitlines(), 1) if "1e-3}" in text)
        self.assertRegex(result.stderr, rf"coarse.yaml:{line}:\d+: simulation.relative_tolerance: 0.001: too coarse")
        self.assertIn("would do", result.stderr)

    def test_what_it_cannot_do_is_explained(self):
        result = call("infer", CART, self.measured, "--refine")
        self.assertEqual(result.returncode, 2)
        self.assertIn("inferred by simulation alone", result.stderr)
        result = call("infer", self.folder / "no.yaml", self.measured)
        self.assertEqual(result.returncode, 2)
        self.assertIn("no.yaml", result.stderr)
        for options in ([], ["--joint"], ["--segments", "1"]):
            result = call("infer", self.measured, self.measured, *options)
            self.assertEqual(result.returncode, 2)
            self.assertIn("measured.csv: is a recording; first give", result.stderr)

    def test_a_parameter_that_nothing_uses_is_named(self):
        tree = yaml.safe_load(CART.read_text())
        tree["parameters"]["mu"] = {"bounds": [0, 1]}
        path = self.folder / "spare.yaml"
        path.write_text(yaml.safe_dump(tree, sort_keys=False))
        table = self.infer(path, self.measured)
        self.assertRegex(table, r": uninformative \(chi-square [\d.]+ of 97 degrees of freedom, p = [\d.]+\)\n")
        self.assertIn("\n  uninformative: nothing uses mu\n    Name it in an expression", table)
        result = call("infer", path, self.measured, "--segments", "1")
        self.assertEqual(result.returncode, 2)
        self.assertIn("nothing uses parameter 'mu'", result.stderr)

    def test_files_of_other_programs_are_named(self):
        for text, words in (
            ('<?xml version="1.0"?>\n<robot name="cart"/>\n', "is a URDF file, which twinmap does not read"),
            ("<mujoco/>", "is a MJCF file"),
            ("PK\x03\x04", "is a ZIP archive, as FMUs are"),
            ("t,x\n0,1\n", "is not an experiment, which begins with its name"),
        ):
            path = self.folder / "model.other"
            path.write_text(text)
            for command in (("infer", path, self.measured), ("diagnose", path, self.measured), ("check", path)):
                result = call(*command)
                self.assertEqual(result.returncode, 2, command)
                self.assertIn(words, result.stderr.splitlines()[0])


if __name__ == "__main__":
    unittest.main()
