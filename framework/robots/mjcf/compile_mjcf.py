"""Answers a line of JSON, {"file": MJCF}, by what MuJoCo compiles of it, or by {"error": why not}. Values at qpos0."""
import json
import sys


def make_pose(position, quaternion):
    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, quaternion)
    return {"origin": position.tolist(), "rotation": matrix.tolist()}


def find_name(model, kind, index, fallback):
    return mujoco.mj_id2name(model, kind, index) or f"{fallback}{index}"


def describe_joint(model, j):
    kind, dof = mujoco.mjtJoint(model.jnt_type[j]).name[6:].lower(), model.jnt_dofadr[j]
    q = model.jnt_qposadr[j]
    joint = {
        "name": find_name(model, mujoco.mjtObj.mjOBJ_JOINT, j, "joint"),
        "kind": kind,
        "origin": model.jnt_pos[j].tolist(),
        "axis": model.jnt_axis[j].tolist(),
        "damping": float(model.dof_damping[dof]),
        "friction": float(model.dof_frictionloss[dof]),
        "armature": float(model.dof_armature[dof]),
        "stiffness": float(np.ravel(model.jnt_stiffness[j])[0]),
        "rest": float(model.qpos_spring[q]),
        "zero": float(model.qpos0[q]),
        "curved": bool(np.any(model.dof_dampingpoly[dof])) or bool(np.any(model.jnt_stiffnesspoly[j])),
    }
    if model.jnt_limited[j]:
        joint["range"] = model.jnt_range[j].tolist()
    return joint


def describe_shape(model, g):
    """What MuJoCo shows of a geom; None of planes, fields and ellipsoids. MuJoCo moves meshes to their inertia's frame."""
    kind = mujoco.mjtGeom(model.geom_type[g]).name[7:].lower()
    size, position, quaternion = model.geom_size[g], model.geom_pos[g].copy(), model.geom_quat[g].copy()
    shape = {"kind": kind}
    if kind == "mesh":
        m, back, turn = model.geom_dataid[g], np.zeros(3), np.zeros(4)
        mujoco.mju_negPose(back, turn, model.mesh_pos[m], model.mesh_quat[m])
        mujoco.mju_mulPose(position, quaternion, model.geom_pos[g], model.geom_quat[g], back, turn)
        shape["file"] = (
            model.paths[model.mesh_pathadr[m] :].split(b"\0")[0].decode() if model.mesh_pathadr[m] >= 0 else ""
        )
        shape["numbers"] = model.mesh_scale[m].tolist()
    elif kind in ("box", "cylinder", "capsule", "sphere"):
        shape["numbers"] = (2 * size).tolist() if kind == "box" else [float(size[0]), float(2 * size[1])]
    else:
        return None
    shape["frame"] = make_pose(position, quaternion)
    return shape


def describe_shapes(model, b):
    first, shown = model.body_geomadr[b], 3  # groups that MuJoCo's own viewer shows at first
    geoms = [g for g in range(first, first + model.body_geomnum[b]) if model.geom_group[g] < shown]
    return [shape for shape in (describe_shape(model, g) for g in geoms) if shape]


def describe_body(model, b):
    first, count = model.body_jntadr[b], model.body_jntnum[b]
    return {
        "name": find_name(model, mujoco.mjtObj.mjOBJ_BODY, b, "body"),
        "parent": int(model.body_parentid[b]),
        "frame": make_pose(model.body_pos[b], model.body_quat[b]),
        "mass": float(model.body_mass[b]),
        "inertial": make_pose(model.body_ipos[b], model.body_iquat[b]),
        "moments": model.body_inertia[b].tolist(),
        "floats": float(model.body_gravcomp[b]),
        "joints": [describe_joint(model, j) for j in range(first, first + count)],
        "shapes": describe_shapes(model, b),
    }


def describe_actuator(model, a):
    on_joint = model.actuator_trntype[a] == mujoco.mjtTrn.mjTRN_JOINT
    gain, bias = model.actuator_gaintype[a], model.actuator_biastype[a]
    plain = (
        on_joint
        and model.jnt_type[model.actuator_trnid[a, 0]] >= int(mujoco.mjtJoint.mjJNT_SLIDE)  # or hinge
        and model.actuator_dyntype[a] == mujoco.mjtDyn.mjDYN_NONE
        and gain == mujoco.mjtGain.mjGAIN_FIXED
        and bias <= int(mujoco.mjtBias.mjBIAS_AFFINE)  # or none
    )
    actuator = {"name": find_name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, a, "actuator"), "plain": bool(plain)}
    if plain:
        actuator["joint"] = find_name(model, mujoco.mjtObj.mjOBJ_JOINT, model.actuator_trnid[a, 0], "joint")
        actuator["gear"] = float(model.actuator_gear[a, 0])
        actuator["gain"] = float(model.actuator_gainprm[a, 0])
        actuator["bias"] = model.actuator_biasprm[a, :3].tolist() if bias else [0, 0, 0]
        if model.actuator_ctrllimited[a]:
            actuator["control_range"] = model.actuator_ctrlrange[a].tolist()
        if model.actuator_forcelimited[a]:
            actuator["force_range"] = model.actuator_forcerange[a].tolist()
    return actuator


def describe_equality(model, e):
    kind, data = mujoco.mjtEq(model.eq_type[e]).name[5:].lower(), model.eq_data[e]
    equality = {"kind": kind, "active": bool(model.eq_active0[e])}
    one, other = int(model.eq_obj1id[e]), int(model.eq_obj2id[e])
    of_bodies = model.eq_objtype[e] == mujoco.mjtObj.mjOBJ_BODY
    if kind == "joint" and other >= 0:
        first, second = (model.qpos0[model.jnt_qposadr[j]] for j in (one, other))
        equality["joints"] = [find_name(model, mujoco.mjtObj.mjOBJ_JOINT, j, "joint") for j in (one, other)]
        equality["ratio"] = float(data[1])
        equality["offset"] = float(first + data[0] - data[1] * second)
        equality["linear"] = not np.any(data[2:5])
    elif kind in ("connect", "weld") and of_bodies:
        equality["bodies"] = [one, other]
        equality["linear"] = True
        if kind == "connect":
            equality["points"] = [data[:3].tolist(), data[3:6].tolist()]
        else:
            equality["points"] = [data[3:6].tolist(), data[:3].tolist()]
            equality["frame"] = make_pose(data[3:6], data[6:10])
    return equality


def describe(file):
    model = mujoco.MjModel.from_xml_path(file)
    return {
        "gravity": model.opt.gravity.tolist(),
        "fluid": bool(model.opt.density or model.opt.viscosity),
        "bodies": [describe_body(model, b) for b in range(model.nbody)],
        "actuators": [describe_actuator(model, a) for a in range(model.nu)],
        "equalities": [describe_equality(model, e) for e in range(model.neq)],
    }


request = json.loads(sys.stdin.readline())
try:
    import mujoco
    import numpy as np
except ImportError:
    answer = {"missing": True}
else:
    try:
        answer = describe(request["file"])
    except Exception as error:
        answer = {"error": str(error)}
print(json.dumps(answer), flush=True)
