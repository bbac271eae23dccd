import pendulum_mujoco
from pendulum_mujoco import XML, observe, set_pendulum, start


def modify(spec, p):
    set_pendulum(spec, p["J"], p["ml"], p["c"], p["drag"])


def control(t, trial):
    return pendulum_mujoco.control(t, trial, end=5)
