from signals import pulse

XML = """
<mujoco>
  <worldbody>
    <body>
      <inertial pos="0 0 0" mass="2" diaginertia="0.01 0.01 0.01"/>
      <joint name="th" type="hinge" axis="0 0 1"/>
      <body name="pay"><inertial pos="0 0 0" mass="1.5" diaginertia="1e-9 1e-9 1e-9"/></body>
    </body>
  </worldbody>
  <actuator><motor name="T" joint="th"/></actuator>
</mujoco>
"""


def modify(spec, p):
    spec.body("pay").pos = [p["e"], 0, 0]
    spec.joint("th").stiffness, spec.joint("th").damping = [p["kt"], 0, 0], [p["d"], 0, 0]


def start(trial):
    return [0]


def control(t, trial):
    return pulse(t, 1, 0.05, 0.2)[:, None]


def observe(s, p):
    return [s.q[:, 0]]
