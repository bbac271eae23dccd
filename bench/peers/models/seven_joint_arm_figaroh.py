"""The arm as URDF, its references, and the ten standard parameters of each link about its joint, in Pinocchio's order."""
import numpy as np
from arm_reference import KD, KP, calc_reference  # noqa: F401

PLACES = ["0 0 0.33", "0 0 0", "0 0 0.32", "0.08 0 0", "-0.08 0 0.38", "0 0 0", "0.09 0 0"]
LINK = """<link name="L{i}"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="q{i}" type="revolute"><parent link="L{before}"/><child link="L{i}"/><origin xyz="{place}"/><axis xyz="{axis}"/>
<limit lower="-3" upper="3" effort="1e3" velocity="10"/></joint>"""
LINKS = [
    LINK.format(i=i, before=i - 1, place=place, axis="0 0 1" if i % 2 else "0 1 0") for i, place in enumerate(PLACES, 1)
]
URDF = f'<robot name="arm"><link name="L0"/>{"".join(LINKS)}</robot>'


def list_standard(p):
    """Mass, first moments, inertia about the joint (xx, xy, yy, xz, yz, zz), link by link."""
    standard = []
    for i in range(1, 8):
        mass, moment = p.get(f"m{i}", 3), p[f"J{i}"]
        c = np.array([p["l6"], 0, 0] if i == 6 else [p["l7"], 0, 0.08] if i == 7 else [0, 0, p.get(f"l{i}", -0.1)])
        about_center = np.diag([0.8 * moment, 0.8 * moment, moment] if i % 2 else [0.8 * moment, moment, 0.8 * moment])
        tensor = about_center + mass * (c @ c * np.eye(3) - np.outer(c, c))
        standard += [mass, *(mass * c), *tensor[[0, 0, 1, 0, 1, 2], [0, 1, 1, 2, 2, 2]]]
    return np.array(standard)
