"""Scenes of the reference run and a loop that integrates exactly and measures on its own.

Nothing here uses the code under test beside ``Navigator`` itself.
"""

import dataclasses
from collections.abc import Callable

import numpy as np

from controllers.motion import Navigator, NavigatorConfig

RADIUS = 0.09
PERIOD = 1.0 / 60.0
BOUNDS = np.array([-2.75, -2.20, 2.75, 2.20])
LANES = np.array([1.2, 0.4, -0.4, -1.2])
BOXES_A = np.array(
    [
        [0.0, 0.8, 0.0, 0.4, 0.5],
        [0.0, -0.8, 0.0, 0.4, 0.5],
        [1.2, 0.0, 0.0, 0.3, 0.3],
    ]
)


@dataclasses.dataclass
class Scene:
    boxes: np.ndarray
    left: np.ndarray
    right: np.ndarray
    around: bool


def scene(name: str) -> Scene:
    if name == "A":
        left = np.column_stack([np.full(4, -2.1), LANES])
        return Scene(BOXES_A, left, left * [-1, 1], True)
    lanes = LANES if name == "cross4" else np.linspace(1.8, -1.8, 10)
    left = np.column_stack([np.full(len(lanes), -2.1), lanes])
    return Scene(np.zeros((0, 5)), left, -left, False)


def ramp_path(p, v, c, samples):
    """Positions (samples, n, 2) inside a cycle whose velocity goes linearly from v to c."""
    t = np.linspace(0.0, PERIOD, samples)[:, None, None]
    return p + v * t + (c - v) * t**2 / (2.0 * PERIOD)


def pair_distances(path):
    i, j = np.triu_indices(path.shape[1], 1)
    return np.linalg.norm(path[:, i] - path[:, j], axis=-1)


def box_distance(points, box):
    """Distance of points (..., 2) to one box (5,); 0 inside."""
    x, y, yaw, hl, hw = box
    d = points - [x, y]
    along = d @ [np.cos(yaw), np.sin(yaw)]
    across = d @ [-np.sin(yaw), np.cos(yaw)]
    return np.hypot(np.maximum(np.abs(along) - hl, 0.0), np.maximum(np.abs(across) - hw, 0.0))


@dataclasses.dataclass
class Result:
    least_gap: float  # least distance between two centres minus 2 r [m]
    least_static_gap: float  # least distance of a centre to boxes and sides minus r [m]
    metric: float  # overlap integrated over time, summed over pairs [mm s]
    reached: np.ndarray  # goals reached by each robot
    commands: np.ndarray  # (cycles, n, 2)
    velocities: np.ndarray  # (cycles, n, 2) before the command
    sampled: int


def run(
    name: str,
    seed: int,
    seconds: float = 30.0,
    fault: Callable[[int, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]] | None = None,
    **settings,
) -> Result:
    """Drive a scene to and fro with exact reports and exact execution.

    ``fault(cycle, position, velocity)`` gives two masks: the robots that obey, and those the
    navigator is told to obey. A robot that does not obey brakes at 6 m/s^2 in whole cycles.
    """
    s = scene(name)
    n = len(s.left)
    config = NavigatorConfig(plan_around_robots=s.around, **settings)
    navigator = Navigator(BOUNDS, s.boxes, n, config, np.random.default_rng(seed))
    p, v, side = s.left.copy(), np.zeros((n, 2)), np.ones(n, dtype=bool)
    gap = static = np.inf
    metric, sampled = 0.0, 0
    reached = np.zeros(n, dtype=int)
    commands, velocities = [], []
    for cycle in range(round(seconds / PERIOD)):
        goal = np.where(side[:, None], s.right, s.left)
        obeys = told = np.ones(n, dtype=bool)
        if fault is not None:
            obeys, told = fault(cycle, p, v)
        c = navigator.step(p, v, goal, told)
        speed = np.linalg.norm(v, axis=1, keepdims=True)
        brake = v * np.maximum(0.0, 1.0 - 6.0 * PERIOD / np.maximum(speed, 1e-12))
        c = np.where(obeys[:, None], c, brake)
        commands.append(c)
        velocities.append(v)
        sampled += int(navigator.sampled.sum())
        path = ramp_path(p, v, c, 9)
        d = pair_distances(path)
        if d.min() < 2 * RADIUS + 0.02:
            path = ramp_path(p, v, c, 401)
            d = pair_distances(path)
            overlap = np.maximum(0.0, 2 * RADIUS - d).sum(axis=1)
            metric += 1e3 * PERIOD * float(np.mean(0.5 * (overlap[1:] + overlap[:-1])))
        gap = min(gap, d.min() - 2 * RADIUS)
        walls = np.minimum(path - BOUNDS[:2], BOUNDS[2:] - path).min()
        static = min(static, walls - RADIUS)
        for box in s.boxes:
            static = min(static, box_distance(path, box).min() - RADIUS)
        p, v = p + 0.5 * (v + c) * PERIOD, c
        done = (np.linalg.norm(p - goal, axis=1) < 0.05) & (np.linalg.norm(v, axis=1) < 0.2)
        side ^= done
        reached += done
    return Result(
        float(gap),
        float(static),
        metric,
        reached,
        np.array(commands),
        np.array(velocities),
        sampled,
    )


def stop_path(p, v, command, cycles=26, inside=24):
    """Positions (samples, 2) of one robot that gets ``command`` and then brakes, step by step."""
    parts = []
    for _ in range(cycles):
        t = np.linspace(0.0, PERIOD, inside, endpoint=False)[:, None]
        parts.append(p + v * t + (command - v) * t**2 / (2.0 * PERIOD))
        p, v = p + 0.5 * (v + command) * PERIOD, command
        speed = np.hypot(*v)
        command = v * max(0.0, 1.0 - 6.0 * PERIOD / speed) if speed > 0.0 else v
    return np.concatenate([*parts, p[None]])
