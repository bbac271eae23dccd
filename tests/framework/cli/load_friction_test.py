"""Friction whose levels depend on load, against closed forms and the same law written as a force."""
import json
import random
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

    def test_a_level_may_depend_on_the_force_of_gravity(self):
        text = (
            BLOCK.replace("bodies:", "gravity: [6, 0, -8]\n  bodies:")
            .replace("mass: 1, joint", "mass: 2, center_of_mass: [0, 0.1, 0], joint")
            .replace("type: slider, ", "type: slider, axis: [1, 0, 0], ")
        )
        friction = "{coordinate: q, model: regularised, onset_speed: 0.1, coulomb: '%s'}"
        for engine in ("lanes", "simbody"):
            known, named = (
                self.simulate(text.format(friction=friction % level, push=3), f"simulation.engine={engine}")
                for level in ("level + 0.3*12", "level + 0.3*abs(q_gravity)")
            )
            for one, other in zip(sum(known, []), sum(named, [])):
                self.assertAlmostEqual(one, other, delta=1e-12)

    def test_the_force_of_gravity_on_a_coordinate_is_of_all_that_its_joint_carries(self):
        text = """
name: arm
parameters: {m: {bounds: [1, 3], unit: kg}}
system:
  gravity: [0, -9.81, 0]
  bodies:
    upper: {mass: m, center_of_mass: [0, -0.3, 0], inertia: 0.1, joint: {type: pin, coordinates: [a]}}
    lower:
      mass: 1.5
      center_of_mass: [0, -0.2, 0]
      inertia: 0.05
      joint: {type: pin, parent: upper, coordinates: [b], in_parent: {point: [0, -0.6, 0]}}
initial: {coordinates: {a: 0.7, b: -1.9}}
outputs:
  a: {coordinate: a}
  b: {coordinate: b}
  ga: {expression: a_gravity, unit: N m}
  gb: {expression: b_gravity, unit: N m}
simulation: {duration: 1}
features: [{samples: {outputs: [a], start: 0, interval: 0.1, count: 11}}]
noise: {stddev: {a: 1, b: 1, ga: 1, gb: 1}}
"""
        for engine in ("lanes", "simbody"):
            for _, a, b, ga, gb in self.simulate(text, f"simulation.engine={engine}", "parameters.m=2"):
                lower = -1.5 * 9.81 * 0.2 * sin(a + b)
                self.assertAlmostEqual(gb, lower, delta=1e-12)
                self.assertAlmostEqual(ga, lower - (2 * 0.3 + 1.5 * 0.6) * 9.81 * sin(a), delta=1e-12)

    def test_friction_that_holds_for_an_instant_lets_go(self):
        # q'' = t - 1 until it halts, just before the force exceeds the level, then again from there
        text = BLOCK.replace("{{coordinate: q, force: push}}", "{{coordinate: q, force: rise*t}}").replace(
            "constants: {{", "constants: {{rise: {{value: 1, unit: N/s}}, "
        )
        text = text.format(friction="{coordinate: q, model: coulomb, coulomb: level}", push=1)
        for less in (1e-8, 1e-12, 1e-13, 1e-14, 3e-15, 1e-15, 5e-16, 0, -1e-15, -1e-14):
            rows = self.simulate(text, f"initial.speeds.q={0.5 - less!r}", "simulation.duration=5")
            for t, q, v in rows:
                self.assertAlmostEqual(v, (t - 1) ** 2 / 2, delta=2 * abs(less) + 1e-9)
                self.assertAlmostEqual(q, ((t - 1) ** 3 + 1) / 6, delta=10 * abs(less) + 1e-9)

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


SERVO = """
name: servo_pendulum
parameters:
  J: {bounds: [0.01, 0.04], unit: kg m2}
  W: {bounds: [0.5, 1.5], unit: N m}
  b: {bounds: [0, 0.2], unit: N m s/rad}
  F: {bounds: [0, 0.5], unit: N m}
system:
  bodies: {arm: {mass: 1, inertia: J, joint: {type: pin, coordinates: [q]}}}
  force_laws: [{coordinate: q, force: u - W*sin(q)}]
  friction: [{coordinate: q, model: coulomb, coulomb: F, viscous: b}]
outputs: {q: {coordinate: q}}
simulation: {duration: 12}
features: [{samples: {outputs: [q], start: 0, interval: 0.02, count: 601}}]
noise: {stddev: {q: 1e-3}}
measurement: {time: t, columns: {q: q}}
excitation: {u: {unit: N m, sines: ["""
SINES = ((0.75, 0.21), (0.35, 0.47), (0.2, 0.83))  # N m, Hz


class Servo:
    """A pendulum behind a gear whose friction grows with the weight that it carries, by Runge and Kutta's method."""

    def __init__(self, seed, carries=True):
        self.random = random.Random(seed)
        draw = self.random.uniform
        self.inertia, self.weight = draw(0.018, 0.03), draw(0.8, 1.2)
        self.viscous, self.level, self.slope = draw(0.02, 0.06), draw(0.05, 0.12), draw(0.08, 0.2) * carries
        self.phases = [draw(0, 2 * pi) for _ in SINES]

    def push(self, t):
        return sum(a * sin(2 * pi * f * t + p) for (a, f), p in zip(SINES, self.phases))

    def hold(self, q):
        return self.level + self.slope * abs(self.weight * sin(q))

    def step(self, t, q, v, side, h):
        def accelerate(q, v, t):
            return (self.push(t) - self.weight * sin(q) - self.viscous * v - side * self.hold(q)) / self.inertia

        a = accelerate(q, v, t)
        v2 = v + h / 2 * a
        b = accelerate(q + h / 2 * v, v2, t + h / 2)
        v3 = v + h / 2 * b
        c = accelerate(q + h / 2 * v2, v3, t + h / 2)
        v4 = v + h * c
        d = accelerate(q + h * v3, v4, t + h)
        return q + h / 6 * (v + 2 * v2 + 2 * v3 + v4), v + h / 6 * (a + 2 * b + 2 * c + d)

    def swing(self, h=2e-4, every=100, count=601):
        """Angles, with noise; at rest until the torque exceeds what friction holds."""
        q, v, side, rows = 0.0, 0.0, 0, []
        for i in range(every * (count - 1) + 1):
            t = i * h
            if i % every == 0:
                rows.append((t, q + self.random.gauss(0, 1e-3)))
            drive = self.push(t) - self.weight * sin(q)
            if side == 0 and abs(drive) > self.hold(q):
                side = 1 if drive > 0 else -1
            if side != 0:
                q_next, v_next = self.step(t, q, v, side, h)
                if v_next * side <= 0:  # halts within the step
                    q, v, side = q + (q_next - q) * (v / (v - v_next) if v != v_next else 0), 0.0, 0
                else:
                    q, v = q_next, v_next
        return rows

    def write(self, folder):
        sines = ", ".join(f"{{amplitude: {a}, frequency: {f}, phase: {p}}}" for (a, f), p in zip(SINES, self.phases))
        (folder / "servo.yaml").write_text(SERVO + sines + "]}}\n")
        rows = "".join(f"{t:.4f},{q:.9g}\n" for t, q in self.swing())
        (folder / "m.csv").write_text("t,q\n" + rows)


class MissingLoad(unittest.TestCase):
    def name_terms(self, servo, of_body=False):
        with tempfile.TemporaryDirectory() as folder:
            servo.write(Path(folder))
            if of_body:
                file = Path(folder) / "servo.yaml"
                text = file.read_text().replace("system:", "system:\n  gravity: [0, -9.81, 0]")
                text = text.replace("mass: 1, ", "mass: 2, center_of_mass: [0, -W/(2*9.81), 0], ")
                file.write_text(text.replace("force: u - W*sin(q)", "force: u"))
            result = call("diagnose", Path(folder) / "servo.yaml", Path(folder) / "m.csv", "--json")
        steps = json.loads(result.stdout)["steps"]
        return [step["candidates"][0]["term"] for step in steps if step["found"]]

    def test_a_servo_without_it_is_told_so(self):
        for seed in (1, 2):
            self.assertEqual(self.name_terms(Servo(seed)), ["load_friction.q"])

    def test_gravity_of_its_body_is_its_load(self):
        self.assertEqual(self.name_terms(Servo(2), of_body=True), ["load_friction.q"])

    def test_of_a_servo_that_carries_its_weight_without_friction_nothing_is_missing(self):
        self.assertEqual(self.name_terms(Servo(1, carries=False)), [])


if __name__ == "__main__":
    unittest.main()
