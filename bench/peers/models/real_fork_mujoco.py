XML = """
<mujoco>
  <option gravity="0 -9.81 0"/>
  <worldbody>
    <body name="fork">
      <inertial pos="0 -0.4778 0" mass="3.22" diaginertia="1 1e-6 1"/>
      <joint name="angle" type="hinge" axis="0 0 1"/>
    </body>
  </worldbody>
</mujoco>
"""


def modify(spec, p):
    spec.body("fork").inertia, spec.joint("angle").damping = [p["J"], 1e-6, p["J"]], [p["c"], 0, 0]


def start(p):
    return [p["angle_0"]], [p["rate_0"]]


def guess(t, gyro):
    """Of what a window leaves unknown: the sensor's bounds are about these."""
    return [0.3, 0, 1, gyro.mean()]


def control(recording, t):
    return t[:, None][:, :0]


def observe(s, p, _):
    return [p["offset"] + p["gain"] * s.v[:, 0]]
