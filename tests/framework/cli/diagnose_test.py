"""What a model lacks: twinmap diagnose as a user meets it."""
import csv
import io
import json
import math
import random
import re
import unittest

from support import EXPERIMENTS, FolderTestCase, call

CART = EXPERIMENTS / "duffing/cart.yaml"
FRICTION = "system.force_laws[0].force=F - k3*x^3 - 0.03*tanh(x_dot/0.01)"


class Diagnose(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.sound = cls.simulate("sound.csv")
        cls.rubbing = cls.simulate("rubbing.csv", FRICTION)

    @classmethod
    def simulate(cls, name, *overrides):
        path = cls.folder / name
        result = call("simulate", CART, "--noise", "--csv", path, "parameters.k=95", *overrides)
        assert result.returncode == 0, result.stderr
        return path

    def diagnose(self, *arguments):
        result = call("diagnose", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_finds_nothing_where_nothing_is_missing(self):
        found = json.loads(self.diagnose(CART, self.sound, "--json"))
        self.assertEqual(found["found"], [])
        self.assertTrue(found["complete"])
        self.assertIn("None of", self.diagnose(CART, self.sound))

    def test_explains_trials_together(self):
        chirp = "{F: {unit: N, chirps: [{amplitude: %s, start_frequency: 0.5, end_frequency: 5, end: 4}]}}"
        trials = "".join(f"  {n}: {{excitation: {chirp % a}}}\n" for n, a in [("soft", 1), ("hard", 4)])
        file = self.folder / "trials.yaml"
        file.write_text(CART.read_text() + "\ntrials:\n" + trials)
        recordings = []
        for trial in ("soft", "hard"):
            drag = "system.force_laws[0].force=F - k3*x^3 - 0.4*abs(x_dot)*x_dot"
            path = self.folder / f"{trial}.csv"
            result = call("simulate", file, "--noise", "--csv", path, f"trial={trial}", drag)
            self.assertEqual(result.returncode, 0, result.stderr)
            recordings += ["--trial", f"{trial}={path}"]
        corrected = self.folder / "with_drag.yaml"
        found = json.loads(self.diagnose(file, *recordings, "--json", "--out", corrected))
        self.assertEqual(found["found"], ["drag.x"])
        inferred = call("infer", corrected, *recordings, "--json")
        self.assertEqual(inferred.returncode, 0, inferred.stderr)
        self.assertIn("drag.x", self.diagnose(file))  # blind spots of both
        soft, page = recordings[1].split("=")[1], self.folder / "p.html"
        own_file = "twinmap check FILE trial=NAME"
        for arguments, words in [
            (["diagnose", file, soft], "which trial does it record"),
            (["diagnose", CART, *recordings[:2]], "has no trials"),
            (["diagnose", file, *recordings, "--page", page], own_file),
            (["infer", file, *recordings, "--diagnose", "--page", page], f"twinmap diagnose {file} --trial"),
            (["validate", file, *recordings, "--against", soft], own_file),
            (["select", file, CART, *recordings], own_file),
        ]:
            refused = call(*arguments)
            self.assertEqual(refused.returncode, 2, refused.stderr)
            self.assertIn(words, refused.stderr)

    def blow(self, seed):
        """A recording of a cart in gusts: random steps of a force that forgets itself within .2 s."""
        numbers = random.Random(seed)
        gust, times, values = 0.0, [], []
        for i in range(251):
            gust = math.exp(-0.1) * gust + 0.02 * math.sqrt(1 - math.exp(-0.2)) * numbers.gauss(0, 1)
            times.append(0.02 * i)
            values.append(gust)
        text = CART.read_text().replace(
            "  F: {unit", f"  W: {{unit: N, tables: [{{times: {times}, values: {values}}}]}}\n  F: {{unit"
        )
        windy = self.folder / "windy.yaml"
        windy.write_text(text.replace("force: F - k3", "force: F + W - k3"))
        path = self.folder / f"gusts{seed}.csv"
        result = call("simulate", windy, "--noise", "--csv", path, "parameters.k=95")
        self.assertEqual(result.returncode, 0, result.stderr)
        return path

    def test_names_a_random_force_before_terms_that_stand_in_for_it(self):
        for seed in (1, 2, 3):
            found = json.loads(self.diagnose(CART, self.blow(seed), "--json"))
            process = found["process"] if found["found"] else found["remainder"]
            self.assertEqual(process["what"], "a force on x")
            for name, truth in (("k", 95), ("d", 1.25), ("k3", 3000)):
                one = process["parameters"][name]
                self.assertLess(abs(one["mean"] - truth), 4 * one["sd"])

    def test_names_the_friction_and_mends_the_parameters(self):
        found = json.loads(self.diagnose(CART, self.rubbing, "--json"))
        self.assertNotIn("process", found)
        self.assertEqual(found["found"], ["coulomb.x"])
        self.assertFalse(found["before"]["explained"])
        self.assertTrue(found["after"]["explained"])
        friction = found["steps"][0]["candidates"][0]
        self.assertLess(abs(friction["size"] - 0.03), 4 * friction["sd"])
        damping = found["parameters"]["d"]
        self.assertLess(abs(damping["mean"] - 1.25), 4 * damping["sd"])
        text = self.diagnose(CART, self.rubbing)
        self.assertIn("1. missing: coulomb.x", text)
        rows = list(csv.DictReader(io.StringIO(self.diagnose(CART, self.rubbing, "--csv"))))
        self.assertEqual([row["term"] for row in rows if row["status"] == "found"], ["coulomb.x"])

    def test_the_page_holds_its_data_and_needs_nothing_else(self):
        path = self.folder / "page.html"
        again = self.simulate("again.csv", FRICTION, "seed=2")
        text = self.diagnose(CART, self.rubbing, again, "--page", path)
        page = path.read_text()
        data = json.loads(re.search(r'id="page-data">(.*?)</script>', page, re.DOTALL).group(1))
        figures = {figure["name"]: figure for figure in data["figures"]}
        self.assertEqual(list(figures), ["force-0", "force-0-time", "residual-0"])
        self.assertEqual([len(figure["panels"]) for figure in figures.values()], [2, 1, 4])
        residual = data["tables"]["residual-0"]
        self.assertEqual(len(residual["before"]), 200)
        self.assertEqual(set(residual["recording"]), {"1", "2"})
        rms = {name: (sum(r * r for r in residual[name]) / 200) ** 0.5 for name in ("before", "after")}
        self.assertGreater(rms["before"], 1.5)
        self.assertLess(rms["after"], 1.2)
        self.expect_step(data["tables"]["force-0-speed"])
        self.assertNotIn("force-0-position", data["tables"])  # no function of that
        self.assertIn("1. missing: coulomb.x", page)
        for name in ("k3", "coulomb_x"):
            self.assertIn(f">{name}</td>", page)
        self.assertIn("coulomb.x", text)
        markup = re.sub(r"<script.*?</script>", "", page, flags=re.DOTALL)
        self.assertEqual(re.findall(r'<(?:script|link|img)[^>]*(?:src|href)="(?!data:)', markup), [])

    def expect_step(self, curve):
        """The band is the friction's, on either side of a speed of 0."""
        rows = list(zip(curve["at"], curve["lower"], curve["upper"]))
        known = [row for row in rows if row[1] is not None and abs(row[0]) > 0.05]
        held = [lower < (-0.03 if speed > 0 else 0.03) < upper for speed, lower, upper in known]
        self.assertGreater(len(known), 30)
        self.assertGreater(sum(held) / len(held), 0.85)

    def test_writes_the_corrected_experiment(self):
        mended = self.folder / "mended.yaml"
        self.diagnose(CART, self.rubbing, "--accept", "coulomb.x", "--out", mended)
        result = call("infer", mended, self.rubbing, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        inferred = json.loads(result.stdout)
        self.assertNotIn("model_mismatch", inferred["statuses"])
        self.assertIn("coulomb_x", inferred["parameters"])

    def test_the_corrected_experiment_reads_what_was_measured_again(self):
        times = [0.005 * i for i in range(1001)]
        rows = "".join(f"{t},{2 * math.sin(9 * t + 2 * t * t)}\n" for t in times)
        (self.folder / "force.csv").write_text("t [s],F [N]\n" + rows)
        chirp = CART.read_text().split("F: {unit: N, ")[1].split("}\n")[0]
        file, mended = self.folder / "measured.yaml", self.folder / "mended.yaml"
        file.write_text(CART.read_text().replace(chirp, "tables: [{measured: {file: force.csv, column: F, time: t}}]"))
        recording = self.folder / "driven.csv"
        result = call("simulate", file, "--noise", "--csv", recording, "parameters.k=95", FRICTION)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.diagnose(file, recording, "--accept", "coulomb.x", "--out", mended)
        self.assertIn("force.csv", mended.read_text())
        self.assertNotIn("values:", mended.read_text())
        inferred = call("infer", mended, recording, "--json")
        self.assertEqual(inferred.returncode, 0, inferred.stderr)
        self.assertNotIn("model_mismatch", json.loads(inferred.stdout)["statuses"])

    def test_noise_of_unknown_size_is_that_of_the_fit(self):
        unknown = self.folder / "unknown.yaml"
        unknown.write_text(CART.read_text().replace("stddev: {x: 1e-4}", "stddev: {x: unknown}"))
        again = self.simulate("again.csv", "seed=2")
        self.assertEqual(call("validate", unknown, self.sound, "--against", again).returncode, 0)
        rubbing = call("validate", unknown, self.sound, "--against", self.rubbing)
        self.assertEqual(rubbing.returncode, 3, rubbing.stderr)
        mended = self.folder / "unknown_mended.yaml"
        self.diagnose(unknown, self.rubbing, "--out", mended)
        chosen = call("select", unknown, mended, self.rubbing, "--json")
        self.assertEqual(chosen.returncode, 0, chosen.stderr)
        result = json.loads(chosen.stdout)
        self.assertEqual(result["structures"][0]["file"], str(mended))
        self.assertAlmostEqual(result["noise"]["x"], 1e-4, delta=2e-5)
        self.assertIn(f"Noise as {mended} leaves it", call("select", unknown, mended, self.rubbing).stdout)
        self.assertIn("differ in the outputs", call("select", CART, mended, self.rubbing).stderr)

    def test_stated_values_predict_without_an_inference(self):
        again = self.simulate("stated.csv", "seed=3", "parameters.k=95", "parameters.d=1.2", "parameters.k3=2500")
        right = call("validate", CART, "--with", "k=95,d=1.2,k3=2500", "--against", again, "--json")
        self.assertEqual(right.returncode, 0, right.stderr)
        row = json.loads(right.stdout)["predictions"][0]
        self.assertAlmostEqual(row["rms"], 1, delta=0.25)
        self.assertAlmostEqual(row["rms_in_units"]["x"], 1e-4 * row["rms"], delta=1e-9)
        wrong = call("validate", CART, "--with", "k=95,d=1.3,k3=2500", "--against", again)
        self.assertEqual(wrong.returncode, 3, wrong.stderr)
        for stated, said in [("k=95", "'d' is not stated"), ("kk=95", "did you mean 'k'"), ("k=a", "NAME=NUMBER")]:
            self.assertIn(said, call("validate", CART, "--with", stated, "--against", again).stderr)
        self.assertIn("--with", call("validate", CART, "--against", again).stderr)

    def test_says_what_a_test_is_blind_to(self):
        spots = {spot["term"]: spot for spot in json.loads(self.diagnose(CART, "--json"))["blind_spots"]}
        self.assertIsNone(spots["damping.x"]["noticed_from"])
        self.assertLess(spots["drag.x"]["shifts"]["d"], -3)
        self.assertIn("never", self.diagnose(CART))

    def test_refuses_what_it_cannot_do(self):
        for arguments, part in [
            ((CART, "--accept", "coulomb.x"), "give their files"),
            ((CART, "--page", self.folder / "none.html"), "give their files"),
            ((CART, self.sound, "--accept", "coulom.x"), "coulomb.x"),
            ((CART, self.sound, "--accept", "damping.x"), "is not a term"),
        ]:
            result = call("diagnose", *arguments)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertIn(part, result.stderr)

    def test_the_page_of_estimates_is_not_that_of_a_diagnosis(self):
        page = self.folder / "none.html"
        result = call("infer", CART, self.sound, "--diagnose", "--page", page)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn(f"twinmap diagnose {CART} {self.sound} --page {page}", result.stderr)
        self.assertFalse(page.exists())


DRIVEN = """name: driven
parameters:
  k: {bounds: [60, 140], unit: N/m}
  d: {bounds: [0.2, 3], unit: N s/m}
nuisance:
  x0: {bounds: [-0.1, 0.1], unit: m}
  v0: {bounds: [-1, 1], unit: m/s}
system:
  bodies: {mass: {mass: 1, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
  dampers: [{coordinate: x, damping: d}]
  force_laws: [{coordinate: x, force: F}]
excitation:
  F: {unit: N, SIGNAL}
initial: {coordinates: {x: x0}, speeds: {x: v0}}
outputs: {x: {coordinate: x}}
simulation: {duration: DURATION}
features: [{samples: {outputs: [x], start: 0.02, interval: 0.02, count: COUNT}}]
noise: {stddev: {x: 2e-4}}
inverse_map: none
"""
SINES = [(1.0, 0.7, 0.3), (0.8, 1.9, 1.0), (0.6, 3.1, 2.0)]  # amplitude, frequency, phase
LATE = 0.04  # s, of the recorder of the force


class DrivenWindows(FolderTestCase):
    """A long recording whose force came 40 ms late to the recorder, explained by windows of it."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        sines = [f"{{amplitude: {a}, frequency: {f}, phase: {p}}}" for a, f, p in SINES]
        cls.write("truth.yaml", f"sines: [{', '.join(sines)}]", 12, 600)
        result = call(
            "simulate", cls.folder / "truth.yaml", "--noise", "parameters.k=95", "parameters.d=1",
            "nuisance.x0=0.02", "nuisance.v0=0.1",
        )  # fmt: skip
        assert result.returncode == 0, result.stderr
        cls.record(result.stdout)
        table = "tables: [{measured: {file: long.csv, column: F, time: t, start: 1}, interpolation: cubic}]"
        cls.write("driven.yaml", table, 2, 99, "measurement: {start: 1}\n")

    @classmethod
    def write(cls, name, signal, duration, count, more=""):
        text = DRIVEN.replace("SIGNAL", signal).replace("DURATION", str(duration)).replace("COUNT", str(count))
        (cls.folder / name).write_text(text + more)

    @classmethod
    def record(cls, simulated):
        lines = ["t,x,F"]
        for row in list(csv.reader(io.StringIO(simulated)))[1:]:
            t = float(row[0])
            force = sum(a * math.sin(2 * math.pi * f * (t - LATE) + p) for a, f, p in SINES)
            lines.append(f"{row[0]},{row[1]},{force!r}")
        (cls.folder / "long.csv").write_text("\n".join(lines) + "\n")

    def test_each_window_has_its_own_excitation(self):
        files = [self.folder / "driven.yaml", self.folder / "long.csv"]
        out = self.folder / "late.yaml"
        starts = ["--start", 1, "--start", 4, "--start", 7]
        found = json.loads(call("diagnose", *files, *starts, "--json", "--out", out).stdout)
        self.assertEqual(found["found"], ["delay.F"])
        delay = found["after"]["parameters"]["delay_F"]
        self.assertLess(abs(delay["mean"] + LATE), 4 * delay["sd"])
        self.assertTrue(found["complete"])
        against = ["--against", files[1], "--against-start", 9.5]
        self.assertEqual(call("validate", *files, *starts, *against).returncode, 3)
        validated = call("validate", out, files[1], *starts, *against)
        self.assertEqual(validated.returncode, 0, validated.stdout + validated.stderr)
        inferred = json.loads(call("infer", out, files[1], "--start", 6, "--json").stdout)
        self.assertEqual(inferred["status"], "ok")
        self.assertLess(abs(inferred["parameters"]["k"]["mean"] - 95), 4 * inferred["parameters"]["k"]["sd"])


if __name__ == "__main__":
    unittest.main()
