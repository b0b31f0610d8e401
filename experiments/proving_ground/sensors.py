"""What robots perceive with, against plain geometry: lidar, sonar, camera, schedule."""

import contextlib
from collections.abc import Mapping
from typing import Any

import cv2
import numpy as np

from experiments.proving_ground.course import LARGE, Array, Metrics, demand, hall, sheet
from mjmr.claims import Bound, Claim
from mjmr.geometry import rotation_matrix
from mjmr.randomness import Streams
from mjmr.robots.pioneer2dx import Pioneer2DX
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.sensors.camera import Camera
from mjmr.sensors.lidar import Lidar
from mjmr.sensors.rangers import Sonar
from mjmr.simulation import Simulation
from mjmr.world import World

NAME = "sensors"
_PLANE = 0.12  # m, height of the scan: through hulls, soccer robots and boxes


def lidar(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Three Pioneers scan boxes, soccer robots and each other, against edges and discs."""
    world, poses = hall(5.0), _places(seed, 12, 4.3)
    for x, y, yaw in poses[:6]:
        world.add_box(x, y, 0.5, 0.3, yaw=yaw, height=0.4)
    pioneers = world.add_group(Pioneer2DX, poses[6:9])
    bots = world.add_group(SoccerBot, poses[9:])
    scanner = pioneers.mount(Lidar(position=(0.0, 0.0, _PLANE), beams=361, field_of_view=2 * np.pi,
                         max_range=20.0))  # fmt: skip
    simulation = Simulation(world, seed=seed)
    for _ in simulation.ticks(0.1):
        pass
    ranges = scanner.read()
    boxes = [(x, y, yaw, 0.25, 0.15) for x, y, yaw in poses[:6]]
    hulls = []
    model = simulation.model
    hull = model.geom("pioneer2dx0/hull")
    # Pioneers rest pitched by a milliradian, which moves what is up in the plane of the scan
    bases = simulation.base_poses_of(pioneers)
    lean = np.array([rotation_matrix(q) @ [0.0, 0.0, _PLANE] for q in bases[:, 3:]])
    there = np.column_stack([bases[:, :2] + lean[:, :2], simulation.poses_of(pioneers)[:, 2]])
    for x, y, yaw in there:
        dx, dy = hull.pos[:2]
        c, s = np.cos(yaw), np.sin(yaw)
        hulls.append((x + c * dx - s * dy, y + s * dx + c * dy, yaw, hull.size[0], hull.size[1]))
    walls = (0.0, 0.0, 0.0, 5.0, 5.0)
    worst = []
    for i, (x, y, yaw) in enumerate(there):
        others = boxes + hulls[:i] + hulls[i + 1 :]
        true = np.full(361, np.inf)
        for k, angle in enumerate(yaw + scanner.angles):
            ray = (np.array([x, y]), np.array([np.cos(angle), np.sin(angle)]))
            found = [_to_box(*ray, box) for box in [walls, *others]]
            found += [_to_disc(*ray, bot[:2], SoccerBot.radius) for bot in bots.start]
            true[k] = min(found)
        # a beam that grazes an edge goes either way
        worst.append(np.sort(np.abs(ranges[i] - true))[:-4].max())
    return {"error_m": float(max(worst))}


def lidar_noise(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Over 100,000 returns of a lidar whose deviation is 20 mm, against one without noise."""
    world = hall(4.0)
    robots = world.add_group(Pioneer2DX, [[0.5, 0.3, 0.4]])
    deviation = 0.02
    noisy = robots.mount(Lidar(rate=50.0, noise=deviation), "noisy")
    exact = robots.mount(Lidar(rate=50.0), "exact")
    errors = []
    for _ in Simulation(world, seed=seed, control_period=0.02).ticks(12.0):
        errors.append(noisy.read() - exact.read())
    all_errors = np.concatenate(errors, axis=None)
    all_errors = all_errors[np.isfinite(all_errors)]
    return {
        "returns": len(all_errors),
        "mean_share": float(all_errors.mean()) / deviation,
        "deviation_ratio": float(all_errors.std()) / deviation,
    }


def sonar(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Where a screen that moves in from the side is first heard, against half the cone's width.

    The screen is 0.1 m thick: its far edge, which is heard first, is nearer to the axis.
    """
    return _first_heard(0.1)


def sonar_thin(condition: Mapping[str, Any], seed: int) -> Metrics:
    """The same with a screen of 2 mm."""
    return _first_heard(0.002)


def _first_heard(thickness: float) -> Metrics:
    errors = []
    for side in (-1.0, 1.0):
        heard, silent, offset = 0.0, np.radians(30.0), 0.0
        # the edge of a screen 2 m ahead, at this bearing from the sonar's axis
        while silent - heard > np.radians(0.02):
            bearing = (heard + silent) / 2
            world = World(bounds=[-6, -6, 6, 6], wall_height=0.5)
            robots = world.add_group(Pioneer2DX, [[0.0, 0.0, 0.0]])
            x, y = 2.0, 2.0 * np.tan(bearing)
            world.add_box(x + thickness / 2, side * (y + 1.0), thickness, 2.0, height=1.0)
            hearing = robots.mount(
                Sonar(sites=("lidar",), max_range=3.0, max_incidence=np.pi / 2, rays=121)
            )
            simulation = Simulation(world)
            for _ in simulation.ticks(0.05):
                pass
            offset = _sites(simulation, robots.prefixes[0] + "lidar")[0]
            if np.isfinite(hearing.read()[0, 0]):
                heard = bearing
            else:
                silent = bearing
        seen_at = np.arctan2(2.0 * np.tan((heard + silent) / 2), 2.0 - offset)
        errors.append(abs(np.degrees(seen_at) - 15.0))
    return {"edge_error_deg": float(max(errors))}


def camera(condition: Mapping[str, Any], seed: int) -> Metrics:
    """Small balls where OpenCV finds them and where they project; depth against rays.

    Some of the balls may lie outside the picture.
    """
    return _balls(seed, (-1.5, 2.0))


def camera_in_view(condition: Mapping[str, Any], seed: int) -> Metrics:
    """The same with balls that all lie in the picture."""
    return _balls(seed, (0.5, 3.0))


def _balls(seed: int, away: tuple[float, float]) -> Metrics:
    import mujoco

    rng = Streams(seed).generator("balls")
    world = hall(4.0)
    robots = world.add_group(Pioneer2DX, [[-3.0, 0.0, 0.0]])
    places = np.column_stack([rng.uniform(*away, 8), np.linspace(-1.5, 1.5, 8)])
    for x, y in places:
        world.add_golf_ball(x, y)
    kind = {"position": (0.0, 0.0, 0.35), "look_at": (3.0, 0.0, 0.0), "fovy": 0.9}
    eye = robots.mount(Camera(width=800, height=600, rate=10.0, **kind), "eye")
    deep = robots.mount(Camera(width=160, height=120, rate=10.0, modality="depth", **kind), "depth")
    simulation = Simulation(world, seed=seed, control_period=0.1)
    with contextlib.closing(simulation):
        for _ in simulation.ticks(0.3):
            pass
        image, depth = eye.read()[0], deep.read()[0]
        model, data = simulation.model, simulation.data
        mujoco.mj_forward(model, data)
        body = data.body("pioneer2dx0/base")
        frame = body.xmat.reshape(3, 3)
        inside = (data.geom_xpos[[model.geom(n).id for n, _ in world.movers]] - body.xpos) @ frame
        pinhole = eye.calibration
        told = pinhole.project(inside)
        found = _orange(image)
        error = [float(np.hypot(*(found - t).T).min()) for t in told]
        ray_error = _depth_error(simulation, deep.calibration, depth, frame, body.xpos)
    return {"pixel_error": max(error), "found": len(found), "depth_error_m": ray_error}


def schedule(condition: Mapping[str, Any], seed: int) -> Metrics:
    """A 10 Hz lidar, 100 ms late, asked every 10 ms: what it delivers is when from when?"""
    world = hall(4.0)
    robots = world.add_group(Pioneer2DX, [[0.0, 0.0, 0.0]])
    scanner = robots.mount(Lidar(rate=10.0, latency=0.1))
    late, instants = [], []
    simulation = Simulation(world, seed=seed, control_period=0.01)
    for now in simulation.ticks(3.0):
        sampled = scanner.sampled_at
        if np.isfinite(sampled) and (not instants or sampled != instants[-1]):
            instants.append(sampled)
            late.append(now - sampled)
    return {
        "latency_error_s": float(np.abs(np.array(late) - 0.1).max()),
        "period_error_s": float(np.abs(np.diff(instants) - 0.1).max()),
        "delivered": len(instants),
    }


def _to_box(origin: Array, way: Array, box: tuple[float, ...]) -> float:
    """Distance along a ray to the edges of a box (x, y, yaw, half-length, half-width)."""
    x, y, yaw, *half = box
    c, s = np.cos(yaw), np.sin(yaw)
    turn = np.array([[c, s], [-s, c]])
    p, d = turn @ (origin - [x, y]), turn @ way
    near = np.inf
    for axis in (0, 1):
        for side in (-half[axis], half[axis]):
            if d[axis] != 0.0:
                t = (side - p[axis]) / d[axis]
                across = p[1 - axis] + t * d[1 - axis]
                if t > 0 and abs(across) <= half[1 - axis]:
                    near = min(near, t)
    return near


def _to_disc(origin: Array, way: Array, centre: Array, radius: float) -> float:
    p = origin - centre
    b, c = p @ way, p @ p - radius**2
    root = b * b - c
    if root < 0 or -b - np.sqrt(root) < 0:
        return np.inf
    return float(-b - np.sqrt(root))


def _places(seed: int, count: int, half: float) -> Array:
    rng = Streams(seed).generator("places")
    found = np.empty((0, 3))
    while len(found) < count:
        pose = rng.uniform([-half, -half, -np.pi], [half, half, np.pi])
        if not len(found) or np.hypot(*(found[:, :2] - pose[:2]).T).min() > 0.7:
            found = np.vstack([found, pose])
    return found


def _sites(simulation: Simulation, name: str) -> Array:
    return np.array(simulation.data.site(name).xpos)


def _orange(image: Any) -> Any:
    """Centres (k, 2) [px] of orange blobs, as OpenCV finds them."""
    hsv = cv2.cvtColor(np.ascontiguousarray(image), cv2.COLOR_RGB2HSV)
    mask = cv2.inRange(hsv, np.array([3, 150, 60]), np.array([22, 255, 255]))
    count, _, stats, centres = cv2.connectedComponentsWithStats(mask)
    # of a picture's first pixel the middle is at (0.5, 0.5)
    return centres[1:count][stats[1:count, cv2.CC_STAT_AREA] > 8] + 0.5


def _depth_error(
    simulation: Simulation, pinhole: Any, depth: Array, frame: Array, origin: Array
) -> float:
    """Largest difference of depths and rays at every fifth pixel, edges of shapes left out."""
    import mujoco

    model, data = simulation.model, simulation.data
    start = origin + frame @ pinhole.position
    group = np.array([1, 1, 0, 0, 0, 0], dtype=np.uint8)
    hit, worst, compared = np.zeros(1, dtype=np.int32), 0.0, 0
    for v in range(2, depth.shape[0] - 2, 5):
        for u in range(2, depth.shape[1] - 2, 5):
            around = depth[v - 1 : v + 2, u - 1 : u + 2]
            if not np.isfinite(around).all() or np.ptp(around) > 0.1:
                continue
            way = frame @ pinhole.rays([u + 0.5, v + 0.5])
            length = np.linalg.norm(way)
            distance = mujoco.mj_ray(model, data, start, way / length, group, 1, -1, hit)
            worst, compared = max(worst, abs(distance / length - float(depth[v, u]))), compared + 1
    demand("pixels with a depth", compared, 100)
    return worst


TESTS = {
    "lidar": lidar,
    "lidar-noise": lidar_noise,
    "sonar": sonar,
    "sonar-thin": sonar_thin,
    "camera": camera,
    "camera-in-view": camera_in_view,
    "schedule": schedule,
}


def claims() -> list[Claim]:
    """What the sensors must do."""
    words = "a sensor says what is there"
    return [
        sheet(NAME, "lidar", "lidar", words, "noise-free ranges of three Pioneers against plain "
              "geometry of walls, boxes, discs and other robots; four beams that graze left out",
              Bound("<=", 1e-4), "error_m", unit="m"),
        sheet(NAME, "lidar-noise", "lidar-noise-mean", "noise has the stated mean",
              "mean error / stated deviation, 100,000 returns", Bound("==", 0.0, 0.05),
              "mean_share"),
        sheet(NAME, "lidar-noise", "lidar-noise-deviation", "noise has the stated deviation",
              "deviation / stated one, 100,000 returns", Bound("==", 1.0, 0.05),
              "deviation_ratio"),
        sheet(NAME, "sonar", "sonar-cone", "a sonar hears what is in its cone",
              "where the edge of a screen is first heard - half the cone, both sides",
              Bound("<=", 1.0), "edge_error_deg", unit="deg", sizes=LARGE),
        sheet(NAME, "sonar-thin", "sonar-cone-thin", "a sonar hears what is in its cone",
              "where the edge of a thin screen is first heard - half the cone, both sides",
              Bound("<=", 1.0), "edge_error_deg", unit="deg", sizes=LARGE),
        sheet(NAME, "camera-in-view", "camera-in-view", "a camera shows things where they project",
              "8 balls, all in the picture, projected centre to the centre OpenCV finds, largest",
              Bound("<=", 1.0), "pixel_error", unit="px"),
        sheet(NAME, "camera", "camera-projection", "a camera shows things where they project",
              "8 balls, some outside the picture, projected centre to the centre OpenCV finds, "
              "largest", Bound("<=", 1.0),
              "pixel_error", unit="px"),
        sheet(NAME, "camera", "camera-depth", "depth images are distances",
              "depth against rays, every fifth pixel, largest", Bound("<=", 0.01),
              "depth_error_m", unit="m"),
        sheet(NAME, "schedule", "latency", "a 10 Hz, 100 ms late sensor delivers exactly that",
              "largest error of the age at delivery, asked every 10 ms", Bound("<=", 1e-6),
              "latency_error_s", unit="s"),
        sheet(NAME, "schedule", "rate", "a 10 Hz, 100 ms late sensor delivers exactly that",
              "largest error of the time between samples", Bound("<=", 1e-6), "period_error_s",
              unit="s"),
    ]  # fmt: skip
