"""Builds the MjSpec of a World: floor, light, wall, field lines, props, robots, cameras."""

from typing import TYPE_CHECKING

import mujoco
import numpy as np

from mjmr.cart import Cart
from mjmr.cart_servos import CartServos, add_cart
from mjmr.disc import Disc, add_disc
from mjmr.pillar import Pillar, add_pillar
from mjmr.robots.platform import FLOOR

if TYPE_CHECKING:
    from mjmr.world import Ball, Box, World

_BOX = mujoco.mjtGeom.mjGEOM_BOX
_LINE_WIDTH = 0.014
OVERVIEW = "overview"
OVERVIEW_FOVY = 42.0


def build_spec(world: "World") -> mujoco.MjSpec:
    """Spec of ``world`` with the options every mjmr world shares.

    Collision geometry is in geom group 0 and what is only seen in group 1, so that rays and
    contacts can be asked for the same shapes.
    """
    spec = mujoco.MjSpec()
    spec.modelname = "mjmr"
    spec.compiler.degree = False
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.impratio = 10.0
    spec.visual.map.znear = 0.01
    _materials(spec, world)
    _lights_and_overview(spec, world)
    _floor(spec, world)
    _wall(spec, world)
    _stripes(spec, world)
    if world.field is not None:
        _field_lines(spec, world.field)
    _marks(spec, world)
    for name, prop in world.named_props():
        if isinstance(prop, Cart):
            add_cart(spec, name, prop)
        elif isinstance(prop, Disc):
            add_disc(spec, name, prop, FLOOR)
        elif isinstance(prop, Pillar):
            add_pillar(spec, name, prop)
        else:
            _prop(spec, name, prop)
    for group in world.groups:
        group.add_to(spec)
    for name, sensor in world.sensors.items():
        sensor.add_to(spec, [""], name)
    spec.visual.quality.offsamples = 0
    spec.visual.global_.offwidth, spec.visual.global_.offheight = 1920, 1080
    # the headlight goes with the camera; where a lamp is to shade the scene it gives nothing
    glow = 0.2 if world.lighting == "uneven" else 0.35
    spec.visual.headlight.ambient = [glow] * 3
    spec.visual.headlight.diffuse = [0.0 if world.lighting == "uneven" else 0.25] * 3
    spec.visual.headlight.specular = [0.0, 0.0, 0.0]
    return spec


def leave_out_drawn(spec: mujoco.MjSpec) -> None:
    """Delete what is only seen from ``spec``: for ``world.edit``, where many robots must be fast.

    MuJoCo moves drawn shapes along at every step: of 200 Pioneers that takes a fifth of the time.
    Films and cameras then show collision shapes alone.
    """
    for geom in list(spec.geoms):
        if geom.group != 0 and geom.contype == 0 and geom.conaffinity == 0:
            spec.delete(geom)


def export_xml(world: "World", timestep: float) -> str:
    """MJCF text of ``world`` with a keyframe ``start``; see :meth:`mjmr.world.World.to_xml`."""
    spec = world.spec()
    spec.option.timestep = timestep
    model = spec.compile()
    data = mujoco.MjData(model)
    for group in world.groups:
        group.platform.bind(model, group.prefixes).place(data, group.start)
    CartServos(model, world).place(data, 0.0)
    for k, joint in enumerate(spec.joints):
        joint.actfrcrange = model.jnt_actfrcrange[model.joint(joint.name).id if joint.name else k]
    spec.add_key(name="start", qpos=data.qpos, act=data.act, ctrl=data.ctrl)
    spec.compile()
    return spec.to_xml()


def _materials(spec: mujoco.MjSpec, world: "World") -> None:
    # plain colours: a texture would double the time of a picture in software
    dark, light = {
        "carpet": ((0.10, 0.36, 0.16), (0.12, 0.40, 0.18)),
        "concrete": ((0.52, 0.53, 0.55), (0.56, 0.57, 0.59)),
    }[world.floor]
    spec.add_material(name="floor", rgba=[*dark, 1], specular=0.0)
    spec.add_material(name="stripe", rgba=[*light, 1], specular=0.0)
    spec.add_material(name="wall", rgba=[0.82, 0.83, 0.85, 1], specular=0.1)
    spec.add_material(name="fixed_box", rgba=[0.55, 0.42, 0.30, 1], specular=0.05)
    spec.add_material(name="free_box", rgba=[0.78, 0.60, 0.32, 1], specular=0.05)
    spec.add_material(name="cart", rgba=[0.80, 0.36, 0.20, 1], specular=0.05)
    spec.add_material(name="mirror", rgba=[0.72, 0.80, 0.86, 1], specular=1.0, shininess=1.0)
    spec.add_material(name="black", rgba=[0.03, 0.03, 0.03, 1], specular=0.0)
    spec.add_material(name="line", rgba=[0.95, 0.95, 0.95, 1], specular=0.0)


def _lights_and_overview(spec: mujoco.MjSpec, world: "World") -> None:
    low, high = world.bounds[:2], world.bounds[2:]
    centre, size = (low + high) / 2, high - low
    far = float(size.max())
    if world.lighting == "uneven":
        _lamp(spec, low + 0.15 * size, far)
    else:
        _sun(spec, centre, far)
    # far enough to see the walls in a 5:4 picture, tilted 15 degrees off the vertical
    half = max(size[1] / 2, size[0] / 2 / 1.25) * 1.16
    distance = half / np.tan(np.radians(OVERVIEW_FOVY / 2))
    tilt = np.radians(15.0)
    pos = [centre[0], centre[1] - distance * np.sin(tilt), distance * np.cos(tilt)]
    quat = [np.cos(tilt / 2), np.sin(tilt / 2), 0.0, 0.0]
    spec.worldbody.add_camera(name=OVERVIEW, pos=pos, quat=quat, fovy=OVERVIEW_FOVY)


def _sun(spec: mujoco.MjSpec, centre: np.ndarray, far: float) -> None:
    spec.worldbody.add_light(
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        pos=[centre[0] - far / 2, centre[1] - far / 2, far],
        dir=[0.45, 0.35, -1.0],
        diffuse=[0.55, 0.55, 0.55],
        specular=[0.15, 0.15, 0.15],
        castshadow=True,
    )


def _lamp(spec: mujoco.MjSpec, at: np.ndarray, far: float) -> None:
    height = 0.6 * far
    spec.worldbody.add_light(
        # wide open: a lamp that shines everywhere below; point lights are not drawn by MuJoCo's GL
        type=mujoco.mjtLightType.mjLIGHT_SPOT,
        pos=[*at, height],
        dir=[0.0, 0.0, -1.0],
        cutoff=90.0,
        exponent=0.0,
        diffuse=[0.85, 0.85, 0.85],
        specular=[0.15, 0.15, 0.15],
        # falls with the square of the distance, to a half at twice the height
        attenuation=[0.67, 0.0, 0.33 / height**2],
        castshadow=True,
    )


def _floor(spec: mujoco.MjSpec, world: "World") -> None:
    low, high = world.bounds[:2], world.bounds[2:]
    half = (high - low) / 2 + 5.0
    spec.worldbody.add_geom(
        name=FLOOR,
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        pos=[*((low + high) / 2), 0],
        size=[half[0], half[1], 0.1],
        material="floor",
        # everything that can touch (bit 1) touches the floor, but what has bit 8 in its place: see
        # mjmr.disc
        contype=4,
        conaffinity=1,
        friction=[0.8, 0.005, 0.0005],
        group=0,
    )


def _stripes(spec: mujoco.MjSpec, world: "World") -> None:
    """Lighter bands across the floor, to see motion by."""
    (x0, y0, x1, y1), h = world.bounds, 0.0002
    count = 2 * max(1, round((x1 - x0) / 1.2)) + 1
    width = (x1 - x0) / count
    for k in range(1, count, 2):
        pos = [x0 + (k + 0.5) * width, (y0 + y1) / 2, h]
        _drawn(spec, pos, [width / 2, (y1 - y0) / 2, h], 0.0, "stripe")


def _wall(spec: mujoco.MjSpec, world: "World") -> None:
    thickness = 0.04
    (x0, y0, x1, y1), h = world.bounds, world.wall_height
    t = thickness / 2
    sides = {
        "wall_west": (x0 - t, (y0 + y1) / 2, t, (y1 - y0) / 2 + thickness),
        "wall_east": (x1 + t, (y0 + y1) / 2, t, (y1 - y0) / 2 + thickness),
        "wall_south": ((x0 + x1) / 2, y0 - t, (x1 - x0) / 2, t),
        "wall_north": ((x0 + x1) / 2, y1 + t, (x1 - x0) / 2, t),
    }
    for name, (x, y, half_x, half_y) in sides.items():
        spec.worldbody.add_geom(
            name=name,
            type=_BOX,
            pos=[x, y, h / 2],
            size=[half_x, half_y, h / 2],
            material="wall" if world.wall_material == "plain" else world.wall_material,
            group=0,
        )


def _field_lines(spec: mujoco.MjSpec, field: np.ndarray) -> None:
    x0, y0, x1, y1 = field
    w, h = _LINE_WIDTH / 2, 0.0008
    middle = (x0 + x1) / 2
    lines = [
        ((x0 + x1) / 2, y0, (x1 - x0) / 2, w),
        ((x0 + x1) / 2, y1, (x1 - x0) / 2, w),
        (x0, (y0 + y1) / 2, w, (y1 - y0) / 2),
        (x1, (y0 + y1) / 2, w, (y1 - y0) / 2),
        (middle, (y0 + y1) / 2, w, (y1 - y0) / 2),
    ]
    for x, y, half_x, half_y in lines:
        _drawn(spec, [x, y, h], [half_x, half_y, h], 0.0, "line")
    radius, sides = 0.5, 40
    for k in range(sides):
        a = 2 * np.pi * (k + 0.5) / sides
        pos = [middle + radius * np.cos(a), (y0 + y1) / 2 + radius * np.sin(a), h]
        half = radius * np.tan(np.pi / sides) + w / 4
        _drawn(spec, pos, [w, half, h], a, "line")


def _marks(spec: mujoco.MjSpec, world: "World") -> None:
    for k, mark in enumerate(world.marks):
        h = 0.0004 + 0.0001 * k  # later ones lie on top
        disc = mark.radius is not None
        size = [mark.radius, h, 0] if disc else [*mark.half_sides, h]
        spec.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CYLINDER if disc else _BOX,
            pos=[mark.x, mark.y, h],
            size=size,
            quat=[np.cos(mark.yaw / 2), 0, 0, np.sin(mark.yaw / 2)],
            rgba=mark.rgba,
            contype=0,
            conaffinity=0,
            group=1,
        )


def _drawn(spec: mujoco.MjSpec, pos: list, size: list, yaw: float, material: str) -> None:
    spec.worldbody.add_geom(
        type=_BOX,
        pos=pos,
        size=size,
        quat=[np.cos(yaw / 2), 0, 0, np.sin(yaw / 2)],
        material=material,
        contype=0,
        conaffinity=0,
        group=1,
    )


def _prop(spec: mujoco.MjSpec, name: str, prop: "Box | Ball") -> None:
    from mjmr.world import Ball

    if isinstance(prop, Ball):
        body = spec.worldbody.add_body(name=name, pos=[prop.x, prop.y, prop.radius])
        body.add_freejoint(name=name)
        inertia = mujoco.mjtGeomInertia
        body.add_geom(
            name=name,
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[prop.radius, 0, 0],
            mass=prop.mass,
            typeinertia=inertia.mjINERTIA_SHELL if prop.shell else inertia.mjINERTIA_VOLUME,
            rgba=prop.rgba,
            # condim 6 lets it roll to a stop; the rolling coefficient is in metres
            condim=6,
            friction=prop.friction,
            solref=prop.solref,
            priority=1,
            group=0,
        )
        return
    quat = [np.cos(prop.yaw / 2), 0, 0, np.sin(prop.yaw / 2)]
    pos = [prop.x, prop.y, prop.height / 2]
    size = [prop.length / 2, prop.width / 2, prop.height / 2]
    look = "fixed_box" if prop.mass is None else "free_box"
    if prop.material != "plain":
        look = prop.material
    if prop.mass is None:
        spec.worldbody.add_geom(
            name=name, type=_BOX, pos=pos, quat=quat, size=size, material=look, group=0
        )
        return
    body = spec.worldbody.add_body(name=name, pos=pos, quat=quat)
    body.add_freejoint(name=name)
    body.add_geom(name=name, type=_BOX, size=size, mass=prop.mass, material=look, group=0)
