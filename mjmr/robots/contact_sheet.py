"""A contact sheet of a robot: front, side, top and what its own camera sees, in one picture."""

import math
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from mjmr.overlay import draw_text
from mjmr.render import Renderer
from mjmr.robots.facts import box_around, facts, needed, stage
from mjmr.robots.platform import Array, Platform
from mjmr.simulation import Simulation
from mjmr.world import Ball, World

WIDTH, HEIGHT = 640, 480  # of each of the four pictures [px]
_CAMERA = "camera"  # what a model calls its camera, or the site where one is mounted
_GAP, _HEAD = 6, 46  # [px]
_INK = (238, 238, 238)


def contact_sheet(platform: Platform) -> NDArray[np.uint8]:
    """RGB picture of a platform on a small floor with a few objects.

    Raises:
        MissingGLError: No off-screen OpenGL.
    """
    simulation = stage(platform, _studio(platform))
    low, high = box_around(simulation, seen=True)
    views = {
        "front": _towards(low, high, azimuth=180.0, elevation=-12.0),
        "side": _towards(low, high, azimuth=90.0, elevation=-12.0),
        "top, ahead is right": _towards(low, high, azimuth=90.0, elevation=-90.0),
    }
    label, own = _own_view(simulation, low, high)
    views[label] = own
    sheet = np.full((_HEAD + 2 * HEIGHT + 2 * _GAP, 2 * WIDTH + 3 * _GAP, 3), 30, dtype=np.uint8)
    with Renderer(simulation.model, WIDTH, HEIGHT, look="fine") as renderer:
        for k, (name, camera) in enumerate(views.items()):
            picture = renderer.picture(simulation.data, camera).copy()
            draw_text(picture, name, (14.0, HEIGHT - 16.0), 0.6, _INK)
            y, x = _HEAD + (k // 2) * (HEIGHT + _GAP), _GAP + (k % 2) * (WIDTH + _GAP)
            sheet[y : y + HEIGHT, x : x + WIDTH] = picture
    known = facts(simulation)
    long, wide, tall = known.size
    draw_text(sheet, platform.title, (14.0, 30.0), 0.75, _INK)
    told = f"{long:.2f} x {wide:.2f} x {tall:.2f} m, {known.mass:.3g} kg, grade {platform.grade}"
    draw_text(sheet, told, (sheet.shape[1] - 14.0, 30.0), 0.55, _INK, align="right")
    return sheet


def _studio(platform: Platform) -> World:
    """A room with boxes and balls ahead of the robot and behind it, sized to it."""
    r = max(platform.radius, 0.05)
    half = max(9.0 * r, needed(platform))
    world = World(bounds=[-half, -half, half, half], floor="concrete", wall_height=0.7 * half)
    for x, y, yaw, side in ((6.5, 2.2, 0.2, 1.2), (7.5, -2.4, -0.3, 0.9), (-4.5, 2.4, 0.9, 1.0)):
        world.add_box(x * r, y * r, side * r, side * r, height=side * r, yaw=yaw, mass=1.0)
    world.add_box(-5.5 * r, -3.2 * r, 2.0 * r, 0.5 * r, height=0.7 * r, yaw=1.2)
    world.add_box(2.5 * r, 5.0 * r, 2.2 * r, 0.6 * r, height=0.8 * r, yaw=0.2)
    for x, y, radius, rgba in (
        (5.0, -0.7, 0.35, (0.95, 0.40, 0.05, 1.0)),
        (-3.0, 4.6, 0.45, (0.10, 0.35, 0.80, 1.0)),
        (7.6, 0.3, 0.45, (0.10, 0.35, 0.80, 1.0)),
    ):
        world.props.append(Ball(x=x * r, y=y * r, radius=radius * r, mass=0.5, rgba=rgba))

    def light(spec: mujoco.MjSpec) -> None:
        # not the whole floor: shadows get finer
        spec.stat.extent, spec.stat.center = 9.0 * r, [0.0, 0.0, 0.0]
        spec.visual.headlight.ambient = [0.25] * 3
        quality = spec.visual.quality
        quality.numslices, quality.numstacks, quality.shadowsize = 96, 48, 8192
        spec.worldbody.add_light(
            type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
            dir=[-0.8, 0.5, -0.25],
            diffuse=[0.35, 0.35, 0.35],
            castshadow=False,
        )

    world.edit(light)
    return world


def _towards(low: Array, high: Array, azimuth: float, elevation: float) -> mujoco.MjvCamera:
    """Camera that looks at a box from outside and has it fill most of the picture.

    Args:
        low: Lowest corner of the box (3,) [m].
        high: Highest corner (3,) [m].
        azimuth: Of the direction it looks in [deg]; 0 along x.
        elevation: Likewise [deg]; -90 straight down.
    """
    size = high - low
    ahead = _direction(azimuth, elevation)
    right = np.array([math.sin(math.radians(azimuth)), -math.cos(math.radians(azimuth)), 0.0])
    up = np.cross(right, ahead)
    # the box's extents in the picture, and towards the camera
    across, above, along = (float(np.abs(axis) @ size) for axis in (right, up, ahead))
    tangent = math.tan(math.radians(45.0) / 2)  # of half the field of view MuJoCo looks with
    half = max(above, across * HEIGHT / WIDTH) / 2
    camera = mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FREE
    camera.lookat[:] = (low + high) / 2
    camera.azimuth, camera.elevation = azimuth, elevation
    camera.distance = 1.25 * half / tangent + along / 2
    return camera


def _own_view(simulation: Simulation, low: Array, high: Array) -> tuple[str, Any]:
    """What the robot's camera is called and where it is: the model's, a mount, or its front."""
    model, data = simulation.model, simulation.data
    name = f"{simulation.world.groups[0].prefixes[0]}{_CAMERA}"
    if mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_CAMERA, name) >= 0:
        return "on board: its camera", name
    site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name)
    if site >= 0:
        eye, ahead = data.site_xpos[site], data.site_xmat[site].reshape(3, 3)[:, 0]
        # a lens stands a little above the plate it is mounted on
        eye = eye + data.site_xmat[site].reshape(3, 3)[:, 2] * 0.05
        label = "on board: at its camera mount"
    else:
        eye = np.array([high[0], (low[1] + high[1]) / 2, high[2]])
        ahead, label = _direction(0.0, -8.0), "on board: from its front (no camera mount)"
    camera = mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FREE
    camera.lookat[:], camera.distance = eye + ahead, 1.0
    camera.azimuth = math.degrees(math.atan2(ahead[1], ahead[0]))
    camera.elevation = math.degrees(math.asin(float(np.clip(ahead[2], -1.0, 1.0))))
    return label, camera


def _direction(azimuth: float, elevation: float) -> Array:
    a, e = math.radians(azimuth), math.radians(elevation)
    return np.array([math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)])
