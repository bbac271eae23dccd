from pendulum_mujoco import XML, control, observe, set_pendulum, start


def modify(spec, p):
    set_pendulum(spec, p["J"], p["ml"], p["c"])
