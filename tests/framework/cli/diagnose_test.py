"""What a model lacks: twinmap diagnose as a user meets it."""
import csv
import io
import json
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

    def test_names_the_friction_and_mends_the_parameters(self):
        found = json.loads(self.diagnose(CART, self.rubbing, "--json"))
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


if __name__ == "__main__":
    unittest.main()
