"""ShapeTable: the collision geometry of a compiled model as arrays that rays are tried against."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
COLLISION_GROUP = 0
SUPPORTED = frozenset(
    int(kind)
    for kind in (
        mujoco.mjtGeom.mjGEOM_PLANE,
        mujoco.mjtGeom.mjGEOM_SPHERE,
        mujoco.mjtGeom.mjGEOM_CAPSULE,
        mujoco.mjtGeom.mjGEOM_ELLIPSOID,
        mujoco.mjtGeom.mjGEOM_CYLINDER,
        mujoco.mjtGeom.mjGEOM_BOX,
    )
)


class ShapeTable(NamedTuple):
    """Shapes of geom group 0, p of them, in the order compiled code takes them.

    What of a robot is hidden inside its own box whatever its joints do, such as the upper part of
    wheels, is left out of bounding spheres, and whole shapes are left out: no ray meets them first.

    Attributes:
        geoms: Their geoms (p,).
        kinds: MuJoCo's types (p,).
        sizes: MuJoCo's sizes (p, 3) [m].
        owners: Robot they belong to, index in the team (p,), -1 for none.
        bodies: Body that carries the bounding sphere (p,).
        offsets: Middle of the bounding sphere in that body's frame (p, 3) [m].
        radii: Of the bounding sphere (p,) [m]; infinite for planes.
    """

    geoms: NDArray[np.int64]
    kinds: NDArray[np.int64]
    sizes: Array
    owners: NDArray[np.int64]
    bodies: NDArray[np.int64]
    offsets: Array
    radii: Array


def seen_geoms(model: Any) -> NDArray[np.bool_]:
    """Geoms that rays can hit (ngeom,): of the collision group, and not wholly transparent."""
    clear = model.geom_rgba[:, 3] == 0.0
    made = model.geom_matid >= 0
    if model.nmat:
        clear &= ~made | (model.mat_rgba[model.geom_matid, 3] == 0.0)
    return (model.geom_group == COLLISION_GROUP) & ~clear


def geom_owners(model: Any, names: Sequence[str]) -> NDArray[np.int64]:
    """Robot that each geom belongs to (ngeom,), -1 for none, from robots' ``names``."""
    number = {name: k for k, name in enumerate(names)}
    of_body = [
        number.get(name.split("/")[0], -1) if "/" in name else -1
        for name in (model.body(b).name for b in range(model.nbody))
    ]
    return np.array(of_body, dtype=np.int64)[model.geom_bodyid]


def shape_table(model: Any, owners: NDArray[np.int64]) -> tuple[ShapeTable, NDArray[np.bool_]]:
    """Table of ``model``, and its geoms that rays can hit but no compiled ray knows (ngeom,).

    Args:
        model: The compiled model.
        owners: See :func:`geom_owners`.
    """
    seen = seen_geoms(model)
    known = np.isin(model.geom_type, list(SUPPORTED))
    geoms = np.flatnonzero(seen & known)
    bodies, offsets = model.geom_bodyid[geoms].astype(np.int64), model.geom_pos[geoms].copy()
    radii = model.geom_rbound[geoms].copy()
    radii[model.geom_type[geoms] == mujoco.mjtGeom.mjGEOM_PLANE] = np.inf
    kept = np.ones(len(geoms), dtype=bool)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    for robot in range(owners.max(initial=-1) + 1):
        rows = np.flatnonzero(owners[geoms] == robot)
        if len(rows):
            _hide(model, data, geoms, rows, bodies, offsets, radii, kept)
    # small ones first: they spare walls and floors, which span many beams, most of these
    order = np.flatnonzero(kept)[np.argsort(radii[kept], kind="stable")]
    geoms = geoms[order]
    table = ShapeTable(
        geoms.astype(np.int64),
        model.geom_type[geoms].astype(np.int64),
        model.geom_size[geoms].copy(),
        owners[geoms],
        bodies[order],
        offsets[order],
        radii[order],
    )
    return table, seen & ~known


def _hide(model, data, geoms, rows, bodies, offsets, radii, kept) -> None:
    """Shrink or drop what of one robot's shapes is always inside one of its boxes."""
    base = int(model.body_rootid[model.geom_bodyid[geoms[rows[0]]]])
    turn = data.xmat[base].reshape(3, 3)
    middles = (data.geom_xpos[geoms[rows]] - data.xpos[base]) @ turn
    turns = np.einsum("ji,njk->nik", turn, data.geom_xmat[geoms[rows]].reshape(-1, 3, 3))
    boxes = [
        k
        for k, row in enumerate(rows)
        if model.geom_type[geoms[row]] == mujoco.mjtGeom.mjGEOM_BOX
        and model.body_weldid[model.geom_bodyid[geoms[row]]] == model.body_weldid[base]
        and np.allclose(turns[k], np.eye(3), atol=1e-9)
    ]
    hidden: set[int] = set()  # not to hide what hides them: two boxes may be the same
    for k, row in enumerate(rows):
        geom = geoms[row]
        if not _fixed_shape(model, base, geom):
            continue
        half = np.abs(turns[k]) @ model.geom_aabb[geom, 3:]
        low, high = middles[k] - half, middles[k] + half
        for b in boxes:
            if b == k or b in hidden:
                continue
            size = model.geom_size[geoms[rows[b]]]
            inside_low, inside_high = middles[b] - size, middles[b] + size
            if (low[:2] < inside_low[:2]).any() or (high[:2] > inside_high[:2]).any():
                continue
            if low[2] >= inside_low[2] and high[2] <= inside_high[2]:
                kept[row] = False
                hidden.add(k)
                break
            if inside_low[2] <= high[2] <= inside_high[2]:
                high[2] = inside_low[2]
            elif inside_low[2] <= low[2] <= inside_high[2]:
                low[2] = inside_high[2]
            else:
                continue
            hidden.add(k)
            middle = (low + high) / 2.0
            bodies[row], offsets[row] = base, middle
            radii[row] = np.linalg.norm(high - middle)


def _fixed_shape(model: Any, base: int, geom: int) -> bool:
    """Whether a geom fills the same space in its base's frame whatever the joints do."""
    body = int(model.geom_bodyid[geom])
    weld = model.body_weldid[body]
    if weld == model.body_weldid[base]:
        return True
    if weld != body or model.body_weldid[model.body_parentid[body]] != model.body_weldid[base]:
        return False
    joint = model.body_jntadr[body]
    if model.body_jntnum[body] != 1 or model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_HINGE:
        return False
    arm = model.geom_pos[geom] - model.jnt_pos[joint]
    if np.linalg.norm(np.cross(arm, model.jnt_axis[joint])) > 1e-9:
        return False
    rotation = np.empty(9)
    mujoco.mju_quat2Mat(rotation, model.geom_quat[geom])
    axis = np.abs(rotation.reshape(3, 3).T @ model.jnt_axis[joint])
    size, kind = model.geom_size[geom], model.geom_type[geom]
    if kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        return True
    if kind == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
        k = int(np.argmax(axis))
        return bool(axis[k] > 1.0 - 1e-9 and np.isclose(*np.delete(size, k)))
    round_kinds = (mujoco.mjtGeom.mjGEOM_CYLINDER, mujoco.mjtGeom.mjGEOM_CAPSULE)
    return bool(kind in round_kinds and axis[2] > 1.0 - 1e-9)
