"""Friction with a bristle is what MuJoCo's dcmotor has (LuGre), here a motor without input, whose back-EMF is nothing beside it."""
#: At 1 ms its bristle is off by 0.6 sds of the noise, an error of first order.
STEP = 1e-4
XML = """
<mujoco>
  <worldbody>
    <body>
      <inertial pos="0 0 0" mass="1.5" diaginertia="1 1 1"/>
      <joint name="q" type="slide" axis="1 0 0"/>
    </body>
  </worldbody>
  <actuator>
    <general name="pull" joint="q"/>
    <dcmotor name="bristle" joint="q" motorconst="1e-6 1e-6" resistance="1" lugre="2e4 60 2.5 3.8 0.03" input="none"/>
  </actuator>
</mujoco>
"""


def modify(spec, p):
    spec.joint("q").stiffness, spec.joint("q").damping = [p["k"], 0, 0], [p["d"], 0, 0]
    spec.actuator("pull").gainprm[0] = p["k"]
    spec.actuator("bristle").biasprm[3:5] = [p["Fc"], p["Fs"]]


def start(trial):
    return [0]


def control(t, trial):
    return 0.08 * t[:, None]


def observe(s, p):
    return [s.q[:, 0], p["k"] * (0.08 * s.t - s.q[:, 0])]
