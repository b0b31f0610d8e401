"""Builds a NIMS: carriage and package scaled to size, two supports and the cable between them."""

import math
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from mjmr.assets import model_path
from mjmr.robots.cable import Cable, swing_period

_GEOM = mujoco.mjtGeom
_PIECES = 32  # straight ones the drawn curve is made of
_BARK = [0.30, 0.22, 0.15, 1.0]
_LEAVES = ([0.13, 0.30, 0.12, 1.0], [0.17, 0.36, 0.14, 1.0], [0.10, 0.25, 0.11, 1.0])


@dataclass(frozen=True, kw_only=True)
class Size:
    """What carriage, package and supports of one size are; see assets/nims/README.md.

    Attributes:
        scale: Of carriage and package against the model file.
        carriage: [kg].
        package: [kg].
        supports: ``"towers"`` or ``"trees"``.
        foot: Radius of what a support covers of the floor [m].
        post: Radius of the post a carriage must keep clear of [m].
        rope: Radius of the cable [m].
        axial_stiffness: Of the cable, EA [N].
    """

    scale: float
    carriage: float
    package: float
    supports: str
    foot: float
    post: float
    rope: float
    axial_stiffness: float


@dataclass(frozen=True, kw_only=True)
class Rig:
    """Everything the model of one NIMS is built from.

    Attributes:
        size: Of carriage, package and supports.
        cable: Its shape.
        tendon: Whether elastic tendons pull the carriage, instead of a curve it slides on.
        reach: Furthest place of the carriage from the middle [m].
        line: Length of the line at the start [m].
        lines: Shortest and longest line [m].
        damping: Of the swing on that line, as a share of critical.
    """

    size: Size
    cable: Cable
    tendon: bool
    reach: float
    line: float
    lines: tuple[float, float]
    damping: float


def build(rig: Rig) -> mujoco.MjSpec:
    """Model of one NIMS; its origin is on the floor below the middle of the cable."""
    spec = mujoco.MjSpec.from_file(str(model_path("nims")))
    for key in list(spec.keys):
        spec.delete(key)
    _scale(spec, rig.size.scale)
    _masses(spec, rig)
    towers = spec.worldbody.add_body(name="towers")
    half, height = rig.cable.shape
    for name, end in (("rear", -half), ("front", half)):
        towers.add_site(name=f"anchor_{name}", pos=[end, 0, height], group=3)
        draw = _mast if rig.size.supports == "towers" else _tree
        draw(towers, rig, end)
    if rig.tendon:
        _tendons(spec, rig)
    else:
        _curve(spec, towers, rig)
    return spec


def _scale(spec: mujoco.MjSpec, scale: float) -> None:
    for kind in (spec.geoms, spec.sites):
        for part in kind:
            part.pos = np.array(part.pos) * scale
            part.size = np.array(part.size) * scale
            if kind is not spec.sites and not math.isnan(part.fromto[0]):
                part.fromto = np.array(part.fromto) * scale
    for part in (*spec.cameras, *spec.frames):
        part.pos = np.array(part.pos) * scale
    for name in ("base", "line", "package"):
        body = spec.body(name)
        body.pos = np.array(body.pos) * scale
        body.ipos = np.array(body.ipos) * scale


def _masses(spec: mujoco.MjSpec, rig: Rig) -> None:
    """Masses, and what goes with them: inertias, servos, travel, damping of the swing."""
    size, base, package = rig.size, spec.body("base"), spec.body("package")
    for body, mass in ((base, size.carriage), (package, size.package)):
        body.inertia = np.array(body.inertia) * (mass / body.mass * size.scale**2)
        body.mass = mass
    spec.body("line").mass = 0.004 * size.package
    base.pos = [0.0, 0.0, rig.cable.height - rig.cable.sag]
    package.pos = [0.0, 0.0, -rig.line]
    along, line = spec.joint("along"), spec.joint("line")
    along.range = [-rig.reach, rig.reach]
    line.ref, line.range = rig.line, list(rig.lines)
    damping = rig.damping * 4.0 * math.pi / swing_period(rig.line) * size.package * rig.line**2
    for name in ("swing", "sway"):
        spec.joint(name).damping[0] = damping
    weight = 9.81 * (size.carriage + size.package)
    # as fast as the servos answer [1/s] times mass; a pulley grips with 0.8 of the weight on it
    _servo(spec.actuator("travel"), 100.0 * size.carriage, (-0.8 * weight, 0.8 * weight))
    _servo(spec.actuator("winch"), 100.0 * size.package, (-3.0 * 9.81 * size.package, 0.0))
    spec.tendon("winch_line").width = 0.4 * size.rope


def _servo(actuator: Any, gain: float, limits: tuple[float, float]) -> None:
    actuator.gainprm[0], actuator.biasprm[2] = gain, -gain
    actuator.forcerange = limits


def _curve(spec: mujoco.MjSpec, towers: Any, rig: Rig) -> None:
    """Height slaved to the place along the cable, and the cable drawn."""
    half = rig.cable.span / 2
    tie = spec.add_equality(name="curve", type=mujoco.mjtEq.mjEQ_JOINT, name1="lift", name2="along")
    tie.data[:5] = [0.0, 0.0, rig.cable.sag / half**2, 0.0, 0.0]
    tie.solref, tie.solimp = [0.02, 1.0], [0.999, 0.9999, 0.001, 0.5, 2.0]
    x = np.linspace(-half, half, _PIECES + 1)
    points = np.column_stack([x, 0.0 * x, rig.cable.curve(x)])
    for begin, end in zip(points[:-1], points[1:], strict=True):
        _drawn(towers, begin, end, rig.size.rope, material="rope")


def _tendons(spec: mujoco.MjSpec, rig: Rig) -> None:
    """Two straight elastic cables from the supports to the carriage, pulled by winches."""
    size = rig.size
    stiffness = size.axial_stiffness / (rig.cable.span / 2)
    # a tenth of critical for carriage and package between both cables
    damping = 0.2 * math.sqrt(stiffness * (size.carriage + size.package))
    spec.delete(spec.actuator("travel"))
    weight = 9.81 * (size.carriage + size.package)
    most = 2.0 * float(rig.cable.tensions(np.linspace(-rig.reach, rig.reach, 9), weight).max())
    for name in ("rear", "front"):
        rope = spec.add_tendon(name=f"cable_{name}", width=size.rope, material="rope")
        rope.wrap_site(f"anchor_{name}")
        rope.wrap_site("hang")
        spec.add_actuator(
            name=f"cable_{name}",
            trntype=mujoco.mjtTrn.mjTRN_TENDON,
            target=f"cable_{name}",
            dyntype=mujoco.mjtDyn.mjDYN_INTEGRATOR,
            gaintype=mujoco.mjtGain.mjGAIN_FIXED,
            biastype=mujoco.mjtBias.mjBIAS_AFFINE,
            gainprm=[stiffness] + [0.0] * 9,
            biasprm=[0.0, -stiffness, -damping] + [0.0] * 7,
            # a cable pulls, it never pushes
            forcerange=[-most, 0.0],
            forcelimited=mujoco.mjtLimited.mjLIMITED_TRUE,
        )


def _mast(towers: Any, rig: Rig, end: float) -> None:
    """An aluminium mast with a cross foot, two stays, a head pulley and a box of electronics."""
    top, post, foot = rig.cable.height, rig.size.post, rig.size.foot
    out = math.copysign(1.0, end)
    towers.add_geom(
        type=_GEOM.mjGEOM_CYLINDER,
        pos=[end + out * post, 0, (top + 0.08) / 2],
        size=[post, (top + 0.08) / 2, 0],
        material="alloy",
        group=0,
        priority=1,
        friction=[0.4, 0.005, 0.0001],
    )
    x, reach = end + out * post, 0.75 * foot
    for dx, dy in ((reach, 0.0), (-reach, 0.0), (0.0, reach), (0.0, -reach)):
        tip = [x + dx, dy, 0.02]
        _drawn(towers, [x, 0, 0.02], tip, 0.016, material="dark")
        _drawn(towers, [x, 0, 0.35 * top], tip, 0.009, material="alloy")
        _ball(towers, tip, [0.026, 0.026, 0.02], material="dark")
    _ball(towers, [x, 0, top + 0.09], [post * 1.15] * 3, material="dark")
    _wheel(towers, [end, 0, top], 0.03, 0.012, material="brass")
    _box(towers, [x + out * post * 2.2, 0, 0.55 * top], [0.04, 0.07, 0.10], material="enclosure")
    _box(towers, [x + out * (post * 2.2 + 0.041), 0, 0.55 * top + 0.02], [0.002, 0.05, 0.035],
         material="dark")  # fmt: skip
    _drawn(towers, [x, 0.03, 0.58 * top], [x, 0.03, 0.98 * top], 0.006, material="dark")


def _tree(towers: Any, rig: Rig, end: float) -> None:
    """A conifer: roots, a trunk in two lengths, whorls of branches; a strap holds the cable."""
    top, post = rig.cable.height, rig.size.post
    out = math.copysign(1.0, end)
    x, crown = end + out * post, 1.45 * top
    for z0, z1, radius in ((0.0, 0.55 * top, post), (0.55 * top, 1.08 * top, 0.72 * post)):
        towers.add_geom(
            type=_GEOM.mjGEOM_CYLINDER,
            pos=[x, 0, (z0 + z1) / 2],
            size=[radius, (z1 - z0) / 2, 0],
            rgba=_BARK,
            group=0,
            priority=1,
            friction=[0.8, 0.005, 0.0001],
        )
    _drawn(towers, [x, 0, 1.05 * top], [x, 0, 0.97 * crown], 0.4 * post, rgba=_BARK)
    for k in range(6):
        a = 2.0 * math.pi * (k + 0.3) / 6
        c, s = math.cos(a), math.sin(a)
        _drawn(towers, [x + 0.6 * post * c, 0.6 * post * s, 0.9 * post],
               [x + 2.1 * post * c, 2.1 * post * s, 0.02], 0.28 * post, rgba=_BARK)  # fmt: skip
    # whorls of flat crossed boughs, the lowest above the cable's end so that they hide nothing
    whorls = 9
    for k in range(whorls):
        share = k / (whorls - 1)
        z = 1.09 * top + share * (crown - 1.09 * top)
        wide = (1.0 - 0.88 * share) * 0.95 * rig.size.foot
        thick = 0.040 * (crown - top) * (1.3 - 0.4 * share)
        for j in range(3):
            a = (2.0 * k + math.pi * j / 3) / 2.0
            turn = [math.cos(a), 0.0, 0.0, math.sin(a)]
            size = [wide * (1.0 - 0.08 * j), 0.55 * wide, thick * (1.0 + 0.3 * (j == 2))]
            _shape(towers, _GEOM.mjGEOM_ELLIPSOID, [x, 0, z - 0.3 * thick * j], size, turn,
                   {"rgba": _LEAVES[(j + k) % 3]})  # fmt: skip
    # dead snags below
    for k in range(5):
        a, z = 2.4 * k + 0.4, (0.45 + 0.09 * k) * top
        tip = [x + 3.2 * post * math.cos(a), 3.2 * post * math.sin(a), z + 0.15]
        _drawn(towers, [x, 0, z], tip, 0.09 * post, rgba=_BARK)
    for dz in (-0.12, 0.12):
        _wheel(towers, [x, 0, top + dz], 0.80 * post, 0.03, [1, 0, 0, 0], material="line")
    _wheel(towers, [end + 0.25 * out * post, 0, top], 0.09, 0.03, material="brass")
    _box(towers, [x - out * 1.05 * post, 0, 1.5], [0.10, 0.18, 0.25], material="enclosure")


def _drawn(body: Any, begin: Any, end: Any, radius: float, **look: Any) -> None:
    body.add_geom(
        type=_GEOM.mjGEOM_CAPSULE,
        fromto=[*begin, *end],
        size=[radius, 0, 0],
        contype=0,
        conaffinity=0,
        group=1,
        **look,
    )


def _ball(body: Any, pos: Any, size: Any, **look: Any) -> None:
    _shape(body, _GEOM.mjGEOM_ELLIPSOID, pos, size, [1, 0, 0, 0], look)


def _box(body: Any, pos: Any, size: Any, **look: Any) -> None:
    _shape(body, _GEOM.mjGEOM_BOX, pos, size, [1, 0, 0, 0], look)


def _wheel(
    body: Any, pos: Any, radius: float, half: float, quat: Any = (0.5**0.5, 0.5**0.5, 0, 0),
    **look: Any,
) -> None:  # fmt: skip
    _shape(body, _GEOM.mjGEOM_CYLINDER, pos, [radius, half, 0], quat, look)


def _shape(body: Any, kind: Any, pos: Any, size: Any, quat: Any, look: dict[str, Any]) -> None:
    body.add_geom(
        type=kind, pos=pos, size=size, quat=quat, contype=0, conaffinity=0, group=1, **look
    )
