"""Marker vision against geometry: how far off are bearings and distances seen by four cameras?

Four Pioneers patrol the office. Each looks round with its cameras once a second; what it makes of
the markers is compared with where the markers were, and with the model of section 6.1.
"""

import contextlib
import math

import numpy as np
from numpy.typing import NDArray

from controllers.motion.patrol import Patrol
from controllers.motion.steering import Steering
from controllers.perception.markers import Marker, MarkerFinder
from experiments.helping_navigation.courtesy import Courtesy
from experiments.helping_navigation.perception import TeammateSight, radio_sight
from experiments.helping_navigation.physical_world import (
    CAMERA_HEIGHT,
    CAMERA_OFFSET,
    CAMERAS,
    MARKER_COLOURS,
    MARKER_HEIGHT,
    MARKER_LENGTH,
    MARKER_RADIUS,
    add_team,
    mount_cameras,
    office_world,
)
from mjmr.geometry import wrap_angle
from mjmr.office import Office
from mjmr.radio import Radio
from mjmr.sensors.line_of_sight import robot_points
from mjmr.sensors.localizer import Localizer
from mjmr.simulation import Simulation

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
ROBOT_SIZE = 0.44  # m: length of the hull, the paper's robotsize
BINS = (0.0, 2.0, 4.0, 6.0, 8.0)  # m
_PERIOD, _LOOKS = 0.1, 1.0  # s, Hz
Metrics = dict[str, float | int]


def run(place: Office, looks: int, radius: float, seed: int) -> Metrics:
    """Patrol and look round ``looks`` times.

    Args:
        place: Where.
        looks: Of each robot, one a second.
        radius: Of sight [m]: what is further off does not count.
        seed: Of the trial.

    Returns:
        See :func:`compare`.
    """
    rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(27,)))
    route = np.array(place.routes[0])
    n = len(MARKER_COLOURS)
    first = int(rng.integers(len(route)))
    phase = [(first + k * len(route) // n) % len(route) for k in range(n)]
    starts = _starts(route, phase, rng)
    world = office_world(place.size, place.walls)
    robots = add_team(world, starts)
    robots.mount(Localizer(rate=1 / _PERIOD, position_noise=0.0, yaw_noise=0.0))
    cameras = mount_cameras(robots, rate=_LOOKS)
    eyes = world.mount(TeammateSight(radius=radius, rate=1 / _PERIOD))
    simulation = Simulation(world, seed=seed, control_period=_PERIOD, dt_max=0.01)
    radio = Radio(simulation, visible=lambda: radio_sight(simulation, radius))
    courtesy, steering = Courtesy(n, radio), Steering()
    patrol = Patrol([route] * n, phase=phase)
    marker = Marker(length=MARKER_LENGTH, radius=MARKER_RADIUS, colours=MARKER_COLOURS)
    finder = MarkerFinder(marker, [camera.calibration for camera in cameras])
    geometry = _Geometry(simulation)
    rows = []
    with contextlib.closing(simulation):
        for k, now in enumerate(simulation.ticks(looks / _LOOKS)):
            pose = robots.localizer.read()
            scan, sight = np.nan_to_num(robots.lidar.read(), nan=np.inf), eyes.read()
            if k % round(1 / _LOOKS / _PERIOD) == 0:
                images = [camera.read() for camera in cameras]
                seen = np.array([finder.find([i[r] for i in images]) for r in range(n)])
                rows.append((*geometry.now, seen))
            way = patrol.step(pose[:, :2], now) - pose[:, :2]
            wish = wrap_angle(np.arctan2(way[:, 1], way[:, 0]) - pose[:, 2])
            wish = courtesy.step(now, wish, pose[:, 2], sight, scan, robots.lidar.angles)
            others = sight[..., :1] * np.stack([np.cos(sight[..., 1]), np.sin(sight[..., 1])], -1)
            reach = np.hypot(*way.T)
            robots.drive(steering.step(wish, reach, scan, robots.lidar.angles, others))
    return compare(*(np.array(column) for column in zip(*rows, strict=True)), radius=radius)


def compare(true: Array, clear: Flags, part: Flags, seen: Array, *, radius: float) -> Metrics:
    """What was seen against what was so.

    Args:
        true: Distance [m] and bearing [rad] of each robot's marker (k, n, n, 2).
        clear: Whether the middle of the mast was in sight (k, n, n).
        part: Whether any of the marker was: its middle or one of its sides.
        seen: What vision made of it (k, n, n, 2), NaN: nothing.
        radius: Further off does not count [m].

    Returns:
        Counts, errors over all that was in sight within ``radius``, and by distance. ``err_max``
        is the paper's whose uniform errors have the measured mean square; ``distance_worst`` the
        largest relative error; ``bearing_worst`` the largest error as a share of the paper's bound.
    """
    n = true.shape[1]
    pairs = ~np.eye(n, dtype=bool) & (true[..., 0] <= radius)
    found = np.isfinite(seen[..., 0])
    both = pairs & part & found
    relative = (seen[..., 0] / true[..., 0] - 1.0)[both]
    bearing = np.abs(wrap_angle(seen[..., 1] - true[..., 1]))[both]
    distance = true[..., 0][both]
    share = bearing / np.arctan(ROBOT_SIZE / 2 / distance)
    metrics: Metrics = {
        "markers_in_sight": int((pairs & clear).sum()),
        "markers_missed": int((pairs & clear & ~found).sum()),
        "markers_phantom": int((pairs & ~part & found).sum()),
        "markers_partly": int((both & ~clear).sum()),
        "err_max": _uniform(relative),
        "distance_worst": float(np.abs(relative).max()) if relative.size else math.nan,
        "distance_bias": float(relative.mean()) if relative.size else math.nan,
        "bearing_worst": float(share.max()) if share.size else math.nan,
        "bearing_rms_deg": float(np.degrees(np.sqrt(np.mean(bearing**2)))),
    }
    for low, high in zip(BINS, BINS[1:], strict=False):
        inside = (distance >= low) & (distance < high)
        name = f"{low:g}_{high:g}m"
        metrics[f"looks_{name}"] = int(inside.sum())
        metrics[f"err_max_{name}"] = _uniform(relative[inside])
        metrics[f"distance_rms_{name}_m"] = _rms(relative[inside] * distance[inside])
        metrics[f"bearing_share_{name}"] = _uniform(share[inside])
    return metrics


def _uniform(errors: Array) -> float:
    """Half-width of the uniform distribution about 0 with the same mean square."""
    return math.sqrt(3.0) * _rms(errors)


def _rms(errors: Array) -> float:
    return float(np.sqrt(np.mean(errors**2))) if errors.size else math.nan


def _starts(route: Array, phase: list[int], rng: np.random.Generator) -> Array:
    """Poses (n, 3) on the way to each first waypoint, headings random."""
    starts = np.empty((len(phase), 3))
    for i, p in enumerate(phase):
        starts[i, :2] = 0.5 * (route[p] + route[p - 1])
        starts[i, 2] = rng.uniform(-math.pi, math.pi)
    return starts


class _Geometry:
    """Where markers are, and whether they are in sight: truth, taken by an observer."""

    def __init__(self, simulation: Simulation):
        self._simulation = simulation
        nobody = np.zeros((0, 0), dtype=bool)
        self.now: tuple[Array, Flags, Flags] = (np.empty((0, 0, 2)), nobody, nobody)
        self._cameras = np.array(
            [
                [
                    CAMERA_OFFSET * np.cos(k * np.pi / 2),
                    CAMERA_OFFSET * np.sin(k * np.pi / 2),
                    CAMERA_HEIGHT - MARKER_HEIGHT,
                ]
                for k in range(len(CAMERAS))
            ]
        )
        simulation.observe(self._look)

    def _look(self) -> None:
        simulation = self._simulation
        scene = simulation.rays
        scene.show(simulation.visible_state())
        masts = robot_points(simulation, MARKER_HEIGHT)
        robots = np.arange(len(masts))
        _, turns = scene.bases()
        apart = np.einsum("nik,nmi->nmk", turns, masts[None] - masts[:, None])
        true = np.stack(
            [np.hypot(apart[..., 0], apart[..., 1]), np.arctan2(apart[..., 1], apart[..., 0])], -1
        )
        clear = scene.clear(masts, masts, robots, robots)
        # from each of the four cameras to the middle and both sides of each marker
        away = masts[None, :, :2] - masts[:, None, :2]
        length = np.maximum(np.linalg.norm(away, axis=2, keepdims=True), 1e-9)
        side = np.stack([-away[..., 1], away[..., 0]], axis=-1) / length * MARKER_RADIUS
        part = clear.copy()
        for k in range(len(masts)):
            eyes = masts[k] + self._cameras @ turns[k].T
            own = np.full(len(eyes), k)
            for sign in (-1.0, 1.0):
                edge = masts.copy()
                edge[:, :2] += sign * side[k]
                part[k] |= scene.clear(eyes, edge, own, robots).any(axis=0)
        self.now = true, clear, part
