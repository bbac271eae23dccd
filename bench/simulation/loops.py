"""What a loop and a bristle cost: processor time of a sample in lanes, and of the same four-bar in MuJoCo, with both errors.

Usage: loops.py TWINMAP [--samples N] [--rounds N]
Needs the Python package mujoco for its row. Time is that of `twinmap run --features-only` with N samples less that with N / 10, so that
points, noise and files are part of it; the median over the rounds, in which the cases alternate.
"""
import argparse
import csv
import os
import resource
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

BODIES = """
    crank: {{mass: m, center_of_mass: [0.05, 0, 0], inertia: 1e-4, joint: {{type: pin, coordinates: [a]}}}}
    coupler:
      mass: 0.3
      center_of_mass: [0.15, 0, 0]
      inertia: 2e-3
      joint: {{type: pin, parent: crank, coordinates: [b], in_parent: {{point: [0.1, 0, 0]}}}}
    rocker:
      mass: 0.25
      center_of_mass: [0.1, 0.01, 0]
      inertia: 1e-3
      joint: {{type: pin, coordinates: [c], in_parent: {{point: [0.25, 0, 0]}}}}
"""
FOUR_BAR = (
    """name: {name}
parameters: {{m: {{bounds: [0.18, 0.22], unit: kg}}}}
system:
  gravity: [0, -9.81, 0]
  bodies:"""
    + BODIES
    + """  dampers: [{{coordinate: a, damping: 2e-3}}]
{constraints}initial: {{coordinates: {{a: 1, b: -0.677, c: 1.112}}, speeds: {{a: 3}}}}
outputs: {{a: {{coordinate: a}}}}
simulation: {{duration: 2}}
features: [{{samples: {{outputs: [a], start: 0.02, interval: 0.02, count: 100}}}}]
noise: {{stddev: {{a: 1e-3}}}}
"""
)
CLOSED = "  constraints: [{coincident: {from: {body: coupler, point: [0.3, 0, 0]}, to: {body: rocker, point: [0.2, 0, 0]}}}]\n"
SLIDE = """name: {name}
parameters: {{m: {{bounds: [1.8, 2.2], unit: kg}}}}
system:
  bodies: {{slide: {{mass: m, joint: {{type: slider, coordinates: [q]}}}}}}
  force_laws: [{{coordinate: q, force: F}}]
  friction: [{{coordinate: q, coulomb: 2, viscous: 4, {friction}}}]
excitation: {{F: {{unit: N, sines: [{{amplitude: 4, frequency: 1}}]}}}}
outputs: {{q: {{coordinate: q}}}}
simulation: {{duration: 2}}
features: [{{samples: {{outputs: [q], start: 0.02, interval: 0.02, count: 100}}}}]
noise: {{stddev: {{q: 1e-5}}}}
"""
CASES = {
    "four_bar": FOUR_BAR.format(name="four_bar", constraints=CLOSED),
    "tree": FOUR_BAR.format(name="tree", constraints=""),
    "lugre": SLIDE.format(name="lugre", friction="model: lugre, bristle: {stiffness: 2e4, damping: 60}"),
    "tanh": SLIDE.format(name="tanh", friction="model: regularised, onset_speed: 1e-3"),
}
MUJOCO = """<mujoco>
  <option gravity="0 -9.81 0"/>
  <worldbody>
    <body name="crank">
      <joint name="a" axis="0 0 1" damping="2e-3"/>
      <inertial pos="0.05 0 0" mass="0.2" diaginertia="1e-4 1e-4 1e-4"/>
      <body name="coupler" pos="0.1 0 0">
        <joint name="b" axis="0 0 1"/>
        <inertial pos="0.15 0 0" mass="0.3" diaginertia="2e-3 2e-3 2e-3"/>
        <site name="coupler" pos="0.3 0 0"/>
      </body>
    </body>
    <body name="rocker" pos="0.25 0 0">
      <joint name="c" axis="0 0 1"/>
      <inertial pos="0.1 0.01 0" mass="0.25" diaginertia="1e-3 1e-3 1e-3"/>
      <site name="rocker" pos="0.2 0 0"/>
    </body>
  </worldbody>
  <equality><connect site1="coupler" site2="rocker"/></equality>
</mujoco>
"""


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("twinmap")
    parser.add_argument("--samples", type=int, default=20000)
    parser.add_argument("--rounds", type=int, default=3)
    return parser.parse_args()


def time_run(twinmap, file, samples, *overrides):
    """Processor seconds of a run that simulates and trains nothing."""
    with tempfile.TemporaryDirectory() as folder:
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        subprocess.run(
            [twinmap, "run", file, "--features-only", "--threads", "1", "--quiet", "--out", f"{folder}/run"]
            + [f"design.train.samples={samples}", "design.test.samples=2", "inverse_map=gp", *overrides],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def time_sample(twinmap, file, samples, *overrides):
    few = samples // 10
    return (time_run(twinmap, file, samples, *overrides) - time_run(twinmap, file, few, *overrides)) / (samples - few)


def simulate(twinmap, file, *overrides):
    """The output over time at the centre of the bounds, and its initial coordinates if it has several."""
    with tempfile.TemporaryDirectory() as folder:
        table = f"{folder}/out.csv"
        subprocess.run([twinmap, "simulate", file, "--csv", table, *overrides], check=True, stdout=subprocess.DEVNULL)
        with open(table, newline="") as stream:
            return [[float(cell) for cell in row] for row in list(csv.reader(stream))[1:]]


def find_error(rows, reference):
    values = [row[1] for row in reference]
    return max(abs(a[1] - b[1]) for a, b in zip(rows, reference)) / (max(values) - min(values))


def run_mujoco(start, speeds, times):
    """The crank's angle at the times by MuJoCo at its default step, and processor seconds of a simulation (of mj_step alone)."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(MUJOCO)
    data = mujoco.MjData(model)
    steps = round(times[-1] / model.opt.timestep)
    every = round((times[1] - times[0]) / model.opt.timestep)

    def reset():
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:] = start, speeds

    reset()
    angles = [data.qpos[0]]
    for _ in range(len(times) - 1):
        mujoco.mj_step(model, data, every)
        angles.append(data.qpos[0])
    taken = []
    for _ in range(20):
        reset()
        before = time.process_time()
        mujoco.mj_step(model, data, steps)  # all steps within one call
        taken.append(time.process_time() - before)
    return [[t, angle] for t, angle in zip(times, angles)], statistics.median(taken)


def main():
    os.environ["OMP_NUM_THREADS"] = "1"
    arguments = parse_arguments()
    with tempfile.TemporaryDirectory() as folder:
        files = {}
        for name, text in CASES.items():
            files[name] = Path(folder) / f"{name}.yaml"
            files[name].write_text(text)
        rounds = {name: [] for name in CASES}
        for _ in range(arguments.rounds):
            for name in CASES:
                rounds[name].append(time_sample(arguments.twinmap, files[name], arguments.samples))
        times = {name: 1e6 * statistics.median(values) for name, values in rounds.items()}
        for name in CASES:
            tight = ["simulation.relative_tolerance=1e-11", "simulation.absolute_tolerance=1e-13"]
            reference = simulate(arguments.twinmap, files[name], *tight)
            error = find_error(simulate(arguments.twinmap, files[name]), reference)
            print(f"{name}: {times[name]:.1f} us a sample, error {error:.1e} of the range", flush=True)
        print(
            f"four-bar: {times['four_bar'] / times['tree']:.2f} times the tree; LuGre: {times['lugre'] / times['tanh']:.2f} times tanh"
        )
        every = [
            "outputs={a: {coordinate: a}, b: {coordinate: b}, c: {coordinate: c}, u: {speed: a}, v: {speed: b}, w: {speed: c}}",
            "noise.stddev={a: 1, b: 1, c: 1, u: 1, v: 1, w: 1}",
            "simulation.relative_tolerance=1e-11",
            "simulation.absolute_tolerance=1e-13",
        ]
        reference = simulate(arguments.twinmap, files["four_bar"], *every)
        rows, seconds = run_mujoco(reference[0][1:4], reference[0][4:7], [row[0] for row in reference])
        print(
            f"MuJoCo's four-bar: {1e6 * seconds:.0f} us, error {find_error(rows, reference):.1e}; "
            f"{1e6 * seconds / times['four_bar']:.0f} times the time in lanes"
        )
        loose = ["simulation.relative_tolerance=1e-4", "simulation.absolute_tolerance=1e-6"]
        own = 1e6 * time_sample(arguments.twinmap, files["four_bar"], arguments.samples, *loose)
        error = find_error(simulate(arguments.twinmap, files["four_bar"], *loose), reference)
        print(
            f"at tolerances of 1e-4: {own:.1f} us, error {error:.1e}; MuJoCo takes {1e6 * seconds / own:.0f} times as long"
        )


if __name__ == "__main__":
    main()
