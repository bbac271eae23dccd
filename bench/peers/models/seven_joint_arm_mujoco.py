"""Joints under PD laws are MuJoCo's actuators with an affine bias; friction as a tanh is in its callback."""
import numpy as np
from arm_reference import KD, KP, calc_reference

#: RK4 is off by 0.01 sds of the noise.
STEP = 5e-3
JOINTS = range(1, 8)
PLACES = ["0 0 0.33", "0 0 0", "0 0 0.32", "0.08 0 0", "-0.08 0 0.38", "0 0 0", "0.09 0 0"]
LINK = """<body name="L{i}" pos="{place}"><inertial pos="0 0 0" mass="3" diaginertia="1 1 1"/>
<joint name="q{i}" type="hinge" axis="{axis}"/>"""
LINKS = [LINK.format(i=i, place=PLACES[i - 1], axis="0 0 1" if i % 2 else "0 1 0") for i in JOINTS]
ACTUATORS = "".join(f'<general name="q{i}" joint="q{i}" biastype="affine"/>' for i in JOINTS)
XML = f"""<mujoco><option gravity="0 0 -9.81"/><worldbody>{"".join(LINKS)}{"</body>" * 7}</worldbody>
<actuator>{ACTUATORS}</actuator><custom><numeric name="f" data="0 0 0 0 0 0 0"/></custom></mujoco>"""


def find_center(i, p):
    if i < 6:
        return [0, 0, p.get(f"l{i}", -0.1)]
    return [p["l6"], 0, 0] if i == 6 else [p["l7"], 0, 0.08]


def modify(spec, p):
    for i, kp, kd in zip(JOINTS, KP, KD):
        link, drive, gain, moment = spec.body(f"L{i}"), spec.actuator(f"q{i}"), p[f"g{i}"], p[f"J{i}"]
        link.mass, link.ipos = p.get(f"m{i}", 3), find_center(i, p)
        link.inertia = [0.8 * moment, 0.8 * moment, moment] if i % 2 else [0.8 * moment, moment, 0.8 * moment]
        spec.joint(f"q{i}").damping = [p[f"b{i}"], 0, 0]
        drive.gainprm[0] = gain * kp
        drive.biasprm[1:3] = [-gain * kp, -gain * kd]
    spec.numerics[0].data = [p[f"f{i}"] for i in JOINTS]


def start(trial):
    return [0] * 7


def control(t, trial):
    return calc_reference(t, trial)


def rub(model, data):
    """mjcb_passive."""
    data.qfrc_passive[:] -= model.numeric_data * np.tanh(data.qvel / 0.1)


def observe(s, p):
    return list(s.q.T)
