"""The drives of the seven-joint arm: their gains, and the references that the experiment's sines give."""
from pathlib import Path

import numpy as np
import yaml

KP, KD = [600, 600, 600, 600, 250, 150, 50], [30, 30, 30, 30, 10, 10, 5]
EXPERIMENT = Path(__file__).resolve().parents[3] / "experiments/mechanisms/seven_joint_arm.yaml"
TRIALS = yaml.safe_load(EXPERIMENT.read_text())["trials"]


def calc_reference(t, trial):
    """A column a joint."""
    add = lambda sines: sum(s["amplitude"] * np.sin(2 * np.pi * s["frequency"] * t + s["phase"]) for s in sines)
    return np.stack([add(TRIALS[trial]["excitation"][f"r{i}"]["sines"]) for i in range(1, 8)], axis=1)
