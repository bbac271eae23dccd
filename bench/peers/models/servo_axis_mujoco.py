"""The loop, its winding and friction as a tanh in MuJoCo's callbacks: its dcmotor clips a voltage before the current is fed back."""
import numpy as np

KP, KD, KI, KC, KN, MOST, L = 6e4, 2500, 8e4, 8, 40, 60, 4e-3
#: The winding with its feedback takes 0.4 ms.
STEP = 5e-4
XML = """
<mujoco>
  <worldbody>
    <body name="axis">
      <inertial pos="0 0 0" mass="20" diaginertia="1 1 1"/>
      <joint name="q" type="slide" axis="1 0 0"/>
    </body>
  </worldbody>
  <actuator>
    <general name="current" joint="q" dyntype="integrator"/>
    <general name="integral" joint="q" dyntype="integrator" gainprm="0"/>
  </actuator>
  <custom><numeric name="p" data="0 0 0"/></custom>
</mujoco>
"""


def modify(spec, p):
    spec.body("axis").mass, spec.joint("q").damping = p["M"], [p["Fv"], 0, 0]
    spec.actuator("current").gainprm[0] = p["k_f"]
    spec.numerics[0].data = [p["Fc"], p["k_f"], p["R"]]


def start(trial):
    return [0]


def control(t, trial):
    return np.zeros((len(t), 2))


def calc_voltage(t, q, v, current, integral):
    e = 0.06 * np.sin(np.pi * t) + 0.02 * np.sin(2 * np.pi * 1.7 * t + 1) - q
    return e, np.clip(KC * ((KP * e + KI * integral - KD * v) / KN - current), -MOST, MOST)


def act(model, data):
    """mjcb_control."""
    _, k_f, resistance = model.numeric_data
    v, current = data.qvel[0], data.act[0]
    e, u = calc_voltage(data.time, data.qpos[0], v, current, data.act[1])
    data.ctrl[:] = (u - resistance * current - k_f * v) / L, e


def rub(model, data):
    """mjcb_passive."""
    data.qfrc_passive[0] -= model.numeric_data[0] * np.tanh(data.qvel[0] / 2e-3)


def observe(s, p):
    q, current = s.q[:, 0], s.act[:, 0]
    return [q, current, calc_voltage(s.t, q, s.v[:, 0], current, s.act[:, 1])[1]]
