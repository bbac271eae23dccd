import numpy as np
from signals import pulse

XML = """
<mujoco>
  <option gravity="0 -9.81 0"/>
  <worldbody>
    <body>
      <inertial pos="0 0 0" mass="2" diaginertia="1e-3 1e-3 1e-3"/>
      <joint name="x" type="slide" axis="1 0 0"/>
      <body name="arm1">
        <inertial pos="0 -0.15 0" mass="0.5" diaginertia="3e-3 1e-6 3e-3"/>
        <joint name="a1" type="hinge" axis="0 0 1"/>
        <body name="arm2" pos="0 -0.3 0">
          <inertial pos="0 -0.125 0" mass="0.4" diaginertia="2e-3 1e-6 2e-3"/>
          <joint name="a2" type="hinge" axis="0 0 1" damping="0.004"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator><motor name="F" joint="x"/></actuator>
</mujoco>
"""


def modify(spec, p):
    spec.joint("x").stiffness, spec.joint("x").damping = [p["k"], 0, 0], [p["d"], 0, 0]
    spec.joint("a1").damping = [p["c1"], 0, 0]
    first, second = spec.body("arm1"), spec.body("arm2")
    moment = 0.5 * p["L1"] ** 2 / 12
    first.ipos, first.inertia, second.pos = [0, -p["L1"] / 2, 0], [moment, 1e-6, moment], [0, -p["L1"], 0]
    moment = p["m2"] * 0.25**2 / 12
    second.mass, second.inertia = p["m2"], [moment, 1e-6, moment]


def start(trial):
    return [0, 0, 0]


def control(t, trial):
    return pulse(t, 10, 0.1, 0.3)[:, None]


def observe(s, p):
    return [s.q[:, 0], s.q[:, 1], s.q[:, 0] + p["L1"] * np.sin(s.q[:, 1]) + 0.25 * np.sin(s.q[:, 1] + s.q[:, 2])]
