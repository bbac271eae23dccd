import numpy as np
from scipy.optimize import brentq
from signals import pulse

XML = """
<mujoco>
  <option gravity="0 0 -9.81"/>
  <worldbody>
    <body>
      <inertial pos="0 0 0" mass="3.3" diaginertia="1e-3 1e-3 1e-3"/>
      <joint name="y" type="slide" axis="0 1 0"/>
      <body>
        <inertial pos="0 0.034 0.022" mass="0.13" diaginertia="1.3e-4 1.3e-4 1.3e-4"/>
        <joint name="theta" type="hinge" axis="1 0 0"/>
      </body>
    </body>
  </worldbody>
  <actuator><motor name="F" joint="y"/><motor name="M" joint="theta"/></actuator>
</mujoco>
"""
THETA = brentq(lambda q: 0.036 * q + 0.13 * 9.81 * (0.034 * np.cos(q) - 0.022 * np.sin(q)), -2, 2)


def modify(spec, p):
    for name in ("y", "theta"):
        spec.joint(name).stiffness = [p[f"k_{name}"], 0, 0]
        spec.joint(name).damping = [p[f"d_{name}"], 0, 0]


def start(trial):
    return [0, THETA]


def control(t, trial):
    return np.stack([pulse(t, 5, 0.2, 0.25), pulse(t, 0.075, 0.2, 0.25)], axis=1)


def observe(s, p):
    return [s.q[:, 0], s.q[:, 1]]
