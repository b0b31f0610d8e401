"""ERRT: a rapidly-exploring random tree with a goal bias and a cache of past waypoints.

Source: Bruce and Veloso 2005, section 2. The planner ignores dynamics and returns one point.
"""

import dataclasses
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.motion.clearance import Scene, check_bounds, prepare_boxes, segment_free
from controllers.motion.streams import next_index, next_uniform, seed_streams
from mjmr.errors import InvalidInputError
from mjmr.jit import njit


@dataclasses.dataclass(frozen=True, kw_only=True)
class ErrtConfig:
    """Parameters of the planner; all but the step are silent in the paper.

    Attributes:
        goal_probability: p, the chance that the tree grows towards the goal.
        waypoint_probability: q, the chance that it grows towards a cached waypoint.
        cache_size: Waypoints kept from successful plans.
        max_nodes: Most growth attempts of one plan (each adds at most one node).
        box_clearance: Free space kept between body and boxes [m].
        disc_clearance: Free space kept between body and discs [m].

    Raises:
        InvalidInputError: A probability outside 0 .. 1 or their sum above 1, a count below 1, or
            a clearance below 0.
    """

    goal_probability: float = 0.1
    waypoint_probability: float = 0.6
    cache_size: int = 200
    max_nodes: int = 2000
    box_clearance: float = 0.015
    disc_clearance: float = 0.03

    def __post_init__(self) -> None:
        p, q = self.goal_probability, self.waypoint_probability
        if not (p >= 0.0 and q >= 0.0 and p + q <= 1.0):
            raise InvalidInputError(
                f"goal_probability {p} and waypoint_probability {q} must be at least 0, "
                "their sum at most 1"
            )
        for name in ("cache_size", "max_nodes"):
            if getattr(self, name) < 1:
                raise InvalidInputError(f"{name} is {getattr(self, name)}; it must be at least 1")
        for name in ("box_clearance", "disc_clearance"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0.0):
                raise InvalidInputError(f"{name} is {value} m; it must be finite and at least 0")


class Forest(NamedTuple):
    """Memory and scratch of the planners of a group, in the form compiled functions take.

    Attributes:
        p: Chance that a tree grows towards the goal.
        q: Chance that it grows towards a cached waypoint.
        cache: Shape (n, size, 2), waypoints of each robot [m], world frame.
        cached: Shape (n,), how many of them are filled.
        streams: Shape (at least n,) uint64, random streams.
        tree: Scratch, shape (2, most nodes), x and y of the nodes.
        parent: Scratch, shape (most nodes,).
    """

    p: float
    q: float
    cache: NDArray[np.float64]
    cached: NDArray[np.int64]
    streams: NDArray[np.uint64]
    tree: NDArray[np.float64]
    parent: NDArray[np.int64]


def make_forest(n: int, config: ErrtConfig, streams: NDArray[np.uint64]) -> Forest:
    """Empty memory for ``n`` robots."""
    return Forest(
        float(config.goal_probability),
        float(config.waypoint_probability),
        np.zeros((n, config.cache_size, 2)),
        np.zeros(n, dtype=np.int64),
        streams,
        np.zeros((2, config.max_nodes + 1)),
        np.zeros(config.max_nodes + 1, dtype=np.int64),
    )


@dataclasses.dataclass(frozen=True)
class Plan:
    """What one plan gave.

    Attributes:
        waypoint: Shape (2,) [m], world frame: furthest point of the path in a straight line.
        success: True if the path reaches the goal's tolerance (half a step).
        nodes: Nodes of the tree; 0 if the straight line was free.
        iterations: Growth attempts.
    """

    waypoint: NDArray[np.float64]
    success: bool
    nodes: int
    iterations: int


class Planner:
    """ERRT for one disc among fixed boxes, with its waypoint cache.

    Args:
        bounds: Shape (4,): xmin, ymin, xmax, ymax [m] that the body stays within.
        boxes: Shape (k, 5): x, y, yaw, half-length, half-width [m, rad]; None for none.
        radius: Radius of the disc [m]; also the step of the tree.
        config: Parameters.
        rng: Seeds the planner's own stream, once.

    Raises:
        InvalidInputError: Bounds, boxes or radius are not acceptable.
    """

    def __init__(
        self,
        bounds: ArrayLike,
        boxes: ArrayLike | None,
        radius: float,
        config: ErrtConfig,
        rng: np.random.Generator,
    ):
        if not (math.isfinite(radius) and radius > 0.0):
            raise InvalidInputError(f"radius is {radius} m; it must be positive and finite")
        self._scene = Scene(
            check_bounds(bounds, radius),
            float(radius),
            prepare_boxes(boxes),
            float(radius + config.box_clearance),
            np.zeros((0, 3)),
            float(radius + config.disc_clearance),
        )
        self._forest = make_forest(1, config, seed_streams(rng, 1))

    def plan(self, start: ArrayLike, goal: ArrayLike, discs: ArrayLike | None = None) -> Plan:
        """Plan from ``start`` to ``goal``.

        Args:
            start: Shape (2,) [m], world frame; may be too near to an obstacle.
            goal: Shape (2,) [m], world frame.
            discs: Shape (m, 3): x, y, radius [m] of other robots; None for none.

        Raises:
            InvalidInputError: A shape is wrong or a number is not finite.
        """
        s, g = np.asarray(start, dtype=np.float64), np.asarray(goal, dtype=np.float64)
        d = np.asarray(np.zeros((0, 3)) if discs is None else discs, dtype=np.float64)
        for name, value, shape in (
            ("start", s, (2,)),
            ("goal", g, (2,)),
            ("discs", d, (len(d), 3)),
        ):
            if value.shape != shape or not np.isfinite(value).all():
                raise InvalidInputError(f"{name} must be finite, shape {shape}, not {value!r}")
        scene = self._scene._replace(discs=np.ascontiguousarray(d))
        x, y, success, nodes, iterations = plan(s[0], s[1], g[0], g[1], scene, -1, self._forest, 0)
        return Plan(np.array([x, y]), bool(success), int(nodes), int(iterations))


@njit
def _nearest(tree, count, x, y):
    """Index of the node nearest to (x, y); a full scan beats a KD-tree at these sizes."""
    best = 0
    best2 = math.inf
    for i in range(count):
        dx = tree[0, i] - x
        dy = tree[1, i] - y
        d2 = dx * dx + dy * dy
        if d2 < best2:
            best2 = d2
            best = i
    return best


@njit
def plan(sx, sy, gx, gy, scene, skip, forest, row):
    """One plan, compiled.

    Args:
        sx: Start [m], world frame; likewise ``sy``.
        sy: See ``sx``.
        gx: Goal [m], world frame; likewise ``gy``.
        gy: See ``gx``.
        scene: A :class:`controllers.motion.clearance.Scene`; its radius is also the step.
        skip: Row of the scene's discs that is this robot; -1 for none.
        forest: A :class:`Forest`; cache and stream of ``row`` are written.
        row: This robot's row in it.

    Returns:
        (x, y, success, nodes, iterations) as in :class:`Plan`.

    Source: Bruce and Veloso 2005, section 2. Ours: a free straight line to the goal is taken at
    once; without success the robot steers to the node nearest to the goal.
    """
    bounds, step, boxes, box_gap, discs, disc_gap = scene
    if segment_free(sx, sy, gx, gy, skip, bounds, step, boxes, box_gap, discs, disc_gap):
        return gx, gy, True, 0, 0
    p, q, cache, cached, streams, tree, parent = forest
    tolerance2 = 0.25 * step * step
    tree[0, 0] = sx
    tree[1, 0] = sy
    parent[0] = -1
    count = 1
    best = 0
    best2 = (gx - sx) ** 2 + (gy - sy) ** 2
    success = best2 <= tolerance2
    iterations = 0
    while not success and iterations < tree.shape[1] - 1:
        iterations += 1
        x, y = _target(gx, gy, bounds, step, p, q, cache, cached, streams, row)
        near = _nearest(tree, count, x, y)
        nx = tree[0, near]
        ny = tree[1, near]
        length = math.sqrt((x - nx) ** 2 + (y - ny) ** 2)
        if length == 0.0:
            continue
        if length > step:
            x = nx + step / length * (x - nx)
            y = ny + step / length * (y - ny)
        if not segment_free(nx, ny, x, y, skip, bounds, step, boxes, box_gap, discs, disc_gap):
            continue
        tree[0, count] = x
        tree[1, count] = y
        parent[count] = near
        d2 = (gx - x) ** 2 + (gy - y) ** 2
        if d2 < best2:
            best2 = d2
            best = count
            success = d2 <= tolerance2
        count += 1
    if success:
        _remember(best, tree, parent, cache, cached, streams, row)
    # The path is walked from its end, so the first node in a straight line is the furthest. The
    # root's child is one by construction; the start itself is left only if nothing could grow.
    node = best
    while parent[node] > 0:
        x = tree[0, node]
        y = tree[1, node]
        if segment_free(sx, sy, x, y, skip, bounds, step, boxes, box_gap, discs, disc_gap):
            break
        node = parent[node]
    return tree[0, node], tree[1, node], success, count, iterations


@njit
def _target(gx, gy, bounds, inset, p, q, cache, cached, streams, row):
    """Random point [m] to grow towards: the goal, a cached waypoint, or anywhere in the field."""
    u = next_uniform(streams, row)
    if u < p:
        return gx, gy
    if u < p + q and cached[row] > 0:
        k = next_index(streams, row, cached[row])
        return cache[row, k, 0], cache[row, k, 1]
    u = next_uniform(streams, row)
    w = next_uniform(streams, row)
    return (
        bounds[0] + inset + (bounds[2] - bounds[0] - 2.0 * inset) * u,
        bounds[1] + inset + (bounds[3] - bounds[1] - 2.0 * inset) * w,
    )


@njit
def _remember(node, tree, parent, cache, cached, streams, row):
    """Add the path that ends at ``node`` to the cache; once full, in random places."""
    size = cache.shape[1]
    while node >= 0:
        w = cached[row]
        if w < size:
            cached[row] += 1
        else:
            w = next_index(streams, row, size)
        cache[row, w, 0] = tree[0, node]
        cache[row, w, 1] = tree[1, node]
        node = parent[node]
