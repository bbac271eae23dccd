"""A pendulum of given inertia about its axis and mass times lever: a body 1 mm from the axis, the rest of its inertia as armature."""
from signals import chirp

XML = """
<mujoco>
  <option gravity="0 -9.81 0"/>
  <worldbody>
    <body name="arm">
      <inertial pos="0 -1e-3 0" mass="300" diaginertia="1e-6 1e-6 1e-6"/>
      <joint name="q" type="hinge" axis="0 0 1"/>
    </body>
  </worldbody>
  <actuator><motor name="T" joint="q"/></actuator>
</mujoco>
"""


def set_pendulum(spec, inertia, mass_lever, damping, drag=0):
    spec.body("arm").mass = mass_lever / 1e-3
    spec.joint("q").armature = inertia - mass_lever * 1e-3 - 1e-6
    spec.joint("q").damping = [damping, drag, 0]


def start(trial):
    return [1 if trial == "free" else 0]


def control(t, trial, end=8):
    return (0 if trial == "free" else 1) * chirp(t, 1, 0.2, 2, end)[:, None]


def observe(s, p):
    return [s.q[:, 0]]
