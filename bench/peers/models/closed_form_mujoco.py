import numpy as np

XML = """
<mujoco>
  <option gravity="0 0 0"/>
  <worldbody>
    <body>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <joint name="x" type="slide" axis="1 0 0"/>
    </body>
  </worldbody>
  <actuator><motor name="a" joint="x"/><motor name="b" joint="x"/></actuator>
</mujoco>
"""


def modify(spec, p):
    for actuator in spec.actuators:
        actuator.gear[0] = p[actuator.name]


def start(trial):
    return [0]


def control(t, trial):
    return np.stack([np.ones_like(t), np.sin(np.pi * t)], axis=1)


def observe(s, p):
    return [s.q[:, 0]]
