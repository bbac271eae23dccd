from signals import chirp

XML = """
<mujoco>
  <worldbody>
    <body>
      <inertial pos="0 0 0" mass="1.2" diaginertia="1 1 1"/>
      <joint name="x" type="slide" axis="1 0 0"/>
    </body>
  </worldbody>
  <actuator><motor name="F" joint="x"/></actuator>
</mujoco>
"""


def modify(spec, p):
    spec.joint("x").stiffness, spec.joint("x").damping = [p["k"], 0, p["k3"]], [p["d"], 0, 0]


def start(trial):
    return [0]


def control(t, trial):
    return chirp(t, 2, 0.5, 5, 4)[:, None]


def observe(s, p):
    return [s.q[:, 0]]
