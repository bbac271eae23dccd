import numpy as np
from scipy.interpolate import CubicSpline

KP, KV, MOST, GAIN = 160.18, 243.45, 10, 35.15065
XML = f"""
<mujoco>
  <worldbody>
    <body name="carriage">
      <inertial pos="0 0 0" mass="100" diaginertia="1 1 1"/>
      <joint name="q" type="slide" axis="1 0 0"/>
    </body>
  </worldbody>
  <actuator>
    <general joint="q" gainprm="{GAIN * KV * KP}" biastype="affine" biasprm="0 {-GAIN * KV * KP} {-GAIN * KV}" forcerange="{-GAIN * MOST} {GAIN * MOST}"/>
  </actuator>
</mujoco>
"""


def modify(spec, p):
    spec.body("carriage").mass, spec.joint("q").damping = p["M"], [p["Fv"], 0, 0]


def start(p):
    return [p["q0"]], [p["v0"]]


def guess(t, q, voltage):
    return [q[0], (q[1] - q[0]) / (t[1] - t[0])]


def control(recording, t):
    if not hasattr(recording, "reference"):
        recording.reference = CubicSpline(recording.take("t"), recording.take("qg"))
    return recording.reference(t)[:, None]


def observe(s, p, reference):
    q = s.q[:, 0]
    return [q, np.clip(KV * (KP * (reference[:, 0] - q) - s.v[:, 0]), -MOST, MOST)]
