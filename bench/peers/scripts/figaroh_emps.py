"""FIGAROH's torque regression of EMPS: filtered, differentiated twice, a regressor of Pinocchio's with friction and offset.

`figaroh_emps.py RECORDING OUT START...`: windows of 4 s. Documentation: the identification pages of FIGAROH and the docstrings of
RegressorBuilder, low_pass_filter_data, calculate_first_second_order_differentiation, relative_stdev. Tried: cut-offs of 60 and of 200
(15 and 50 Hz; the latter is kept). Every tenth sample is used, as its decimation does by default.
"""
import json
import sys
import tempfile
from pathlib import Path

import numpy as np
from figaroh.identification.identification_tools import (
    calculate_first_second_order_differentiation,
    low_pass_filter_data,
    relative_stdev,
)
from figaroh.tools.regressor import RegressorBuilder, RegressorConfig
from figaroh.tools.robot import Robot
from scipy.io import loadmat

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from harness import listen

URDF = """<robot name="emps">
  <link name="base"/>
  <link name="carriage"><inertial><mass value="90"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="q" type="prismatic">
    <parent link="base"/><child link="carriage"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1e3" velocity="10"/>
  </joint>
</robot>"""
SETTINGS = {"ts": 1e-3, "cut_off_frequency_butterworth": 200, "act_idxv": [0]}
DECIMATION, WINDOW = 10, 4.0


def identify(recording, starts):
    with tempfile.TemporaryDirectory() as folder:
        urdf = Path(folder) / "emps.urdf"
        urdf.write_text(URDF)
        robot = Robot(str(urdf), package_dirs=folder)
    builder = RegressorBuilder(robot, RegressorConfig(has_friction=True, has_joint_offset=True))
    data = loadmat(recording)
    times, rows, forces = data["t"].ravel(), [], []
    for start in starts:
        within = (times >= start) & (times < start + WINDOW)
        angles = low_pass_filter_data(data["qm"][within], SETTINGS)
        q, dq, ddq = calculate_first_second_order_differentiation(robot.model, angles, SETTINGS)
        force = low_pass_filter_data(data["gtau"].item() * data["vir"][within], SETTINGS)[:-2, 0]
        rows.append(builder.build_basic_regressor(q, dq, ddq, SETTINGS)[::DECIMATION])
        forces.append(force[::DECIMATION])
    regressor, force = np.vstack(rows), np.concatenate(forces)
    acting = np.abs(regressor).sum(axis=0) > 1e-3
    found = np.linalg.lstsq(regressor[:, acting], force, rcond=None)[0]
    return found, np.abs(found) * relative_stdev(regressor[:, acting], found, force) / 100


def main():
    recording, out, *starts = sys.argv[1:]
    (found, sds), seconds, _, said = listen(lambda: identify(recording, [float(start) for start in starts]))
    names = ["M", "Fv", "Fc", "offset"]
    values = dict(zip(names, found.tolist()))
    answer = {"values": values, "sds": dict(zip(names, sds.tolist())), "warnings": said, "seconds": seconds}
    Path(out).write_text(json.dumps(answer))


if __name__ == "__main__":
    main()
