"""Friction whose levels depend on load, against closed forms and the same law written as a force."""
import tempfile
import unittest
from math import atan2, cos, pi, sin, sqrt
from pathlib import Path

from support import call

# A block that slides to a halt on ground that gets rougher along q, and is pushed from PUSH on.
LEVEL, SLOPE, SPEED, PUSH, DURATION = 1.0, 0.5, 2.0, 4.0, 5.0
BLOCK = """
name: block
parameters: {{slope: {{bounds: [0.4, 0.6], unit: N/m}}}}
constants: {{level: {{value: 1, unit: N}}}}
system:
  bodies: {{block: {{mass: 1, joint: {{type: slider, coordinates: [q]}}}}}}
  force_laws: [{{coordinate: q, force: push}}]
  friction: [{friction}]
excitation: {{push: {{unit: N, pulses: [{{amplitude: {push}, start: 4, end: 9}}]}}}}
initial: {{speeds: {{q: 2}}}}
outputs: {{q: {{coordinate: q}}, v: {{speed: q}}}}
simulation: {{duration: 5, relative_tolerance: 1e-10, absolute_tolerance: 1e-12}}
features: [{{samples: {{outputs: [q, v], start: 0, interval: 0.05, count: 101}}}}]
noise: {{stddev: {{q: 1, v: 1}}}}
"""
STICKING = "{coordinate: q, model: coulomb, coulomb: 'level + slope*q'}"
W = sqrt(SLOPE)


def swing(q, v, rest, t):
    """Of q'' = -SLOPE (q - rest) from q, v."""
    return rest + (q - rest) * cos(W * t) + v / W * sin(W * t), -(q - rest) * W * sin(W * t) + v * cos(W * t)


class LoadFriction(unittest.TestCase):
    def simulate(self, text, *overrides):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "block.yaml"
            file.write_text(text)
            result = call("simulate", file, *overrides)
        self.assertEqual(result.returncode, 0, result.stderr)
        return [[float(word) for word in line.split(",")] for line in result.stdout.splitlines()[1:]]

    def test_a_block_slides_to_its_halt_and_sticks_there_until_its_level_is_exceeded(self):
        slide = -LEVEL / SLOPE  # where q'' = -(LEVEL + SLOPE q) would rest
        halt = atan2(SPEED / W, -slide) / W
        place = swing(0, SPEED, slide, halt)[0]
        held = LEVEL + SLOPE * place
        for push in (0.999 * held, 1.5 * held):
            for t, q, v in self.simulate(BLOCK.format(friction=STICKING, push=push)):
                expected = swing(0, SPEED, slide, t) if t < halt else (place, 0)
                if t > PUSH and push > held:
                    expected = swing(place, 0, (push - LEVEL) / SLOPE, t - PUSH)
                self.assertAlmostEqual(q, expected[0], delta=1e-8)
                self.assertAlmostEqual(v, expected[1], delta=1e-7)
        self.assertLess(DURATION - PUSH, pi / W)  # it has not turned

    def test_all_levels_may_use_coordinates_speeds_and_signals(self):
        friction = (
            "{coordinate: q, model: regularised, onset_speed: 0.1, coulomb: 'level + slope*abs(q)',"
            " viscous: '0.2*(1 + sin(q))', stribeck: {level: 'level + 0.3*abs(push)', speed: 0.5}}"
        )
        force = (
            "push - ((level + slope*abs(q)) + ((level + 0.3*abs(push)) - (level + slope*abs(q)))"
            "*exp(-(abs(q_dot)/0.5)^2))*tanh(q_dot/0.1) - 0.2*(1 + sin(q))*q_dot"
        )
        text = BLOCK.format(friction=friction, push=3)
        as_force = text.replace(f"  friction: [{friction}]\n", "").replace("force: push", f"force: '{force}'")
        for engine in ("lanes", "simbody"):
            rows = self.simulate(text, f"simulation.engine={engine}")
            for row, expected in zip(rows, self.simulate(as_force)):
                for one, other in zip(row, expected):
                    self.assertAlmostEqual(one, other, delta=1e-8)

    def test_a_bristle_carries_a_level_that_depends_on_a_signal(self):
        friction = (
            "{coordinate: q, model: lugre, coulomb: 'level + 0.5*abs(push)', bristle: {stiffness: 1e4, damping: 100}}"
        )
        rows = self.simulate(BLOCK.format(friction=friction, push=1.9))
        at = {round(t, 2): (q, v) for t, q, v in rows}
        self.assertLess(abs(at[4.9][1]), 1e-3)  # 1 + 0.95 holds 1.9
        rows = self.simulate(BLOCK.format(friction=friction, push=2.5))
        at = {round(t, 2): (q, v) for t, q, v in rows}
        self.assertGreater(at[4.9][1], 0.2)  # 2.5 > 1 + 1.25: 0.25 N over 0.9 s

    def test_a_level_is_checked_for_names_units_and_sign(self):
        for friction, message in (
            (STICKING.replace("slope*q", "slope*z"), "unknown name 'z'"),
            (STICKING.replace("slope*q", "slope"), "N/m"),
            (STICKING.replace("level + slope*q", "0 - level"), "must not be negative"),
        ):
            with tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "block.yaml"
                file.write_text(BLOCK.format(friction=friction, push=1))
                result = call("simulate", file)
            self.assertEqual(result.returncode, 2, friction)
            self.assertIn(message, result.stderr)


if __name__ == "__main__":
    unittest.main()
