import numpy as np

M1, M2, L1 = 10, 0.6256, 0.2
XML = f"""
<mujoco>
  <option gravity="0 -9.81 0"/>
  <worldbody>
    <body name="upper">
      <inertial pos="0 -0.01 0" mass="{M1}" diaginertia="1 1e-6 1"/>
      <joint name="q1" type="hinge" axis="0 0 1"/>
      <body name="lower" pos="0 {-L1} 0">
        <inertial pos="0 -0.1 0" mass="{M2}" diaginertia="1 1e-6 1"/>
        <joint name="q2" type="hinge" axis="0 0 1"/>
      </body>
    </body>
  </worldbody>
  <actuator><motor joint="q1"/><motor joint="q2"/></actuator>
</mujoco>
"""


def modify(spec, p):
    upper, lower = spec.body("upper"), spec.body("lower")
    first = p["S1"] - M2 * L1
    moment = p["J1"] - M2 * L1**2 - first**2 / M1
    upper.ipos, upper.inertia = [0, -first / M1, 0], [moment, 1e-6, moment]
    lower.ipos, lower.inertia = [0, -p["S2"] / M2, 0], [p["I2"], 1e-6, p["I2"]]
    for i in "12":
        spec.joint(f"q{i}").damping = [p[f"b{i}"], 0, 0]


def start(p):
    return [p["q1_0"], p["q2_0"]], [p["w1_0"], p["w2_0"]]


def guess(t, *outputs):
    return [output[0] for output in outputs]


def control(recording, t):
    return np.stack([np.interp(t, recording.take("time"), recording.take(f"tau_meas{i}")) for i in "12"], axis=1)


def observe(s, p, _):
    return [*s.q.T, *s.v.T]
