"""Worlds and plain geometry that tests of ray-based sensors share."""

import numpy as np

from mjmr.robots import Pioneer2DX, SoccerBot
from mjmr.world import World


def hall(**options):
    """Walls of 0.5 m around 8 m x 6 m."""
    return World.rectangle(8.0, 6.0, **({"wall_height": 0.5} | options))


def crowded(seed, **options):
    """Both kinds of robots, boxes fixed and free, a ball and a cart, at random."""
    rng = np.random.default_rng(seed)
    world = World.rectangle(12.0, 9.0, **({"wall_height": 0.5} | options))
    axes = np.meshgrid(np.arange(-5.1, 5.2, 0.95), np.arange(-3.6, 3.7, 0.95))
    spots = np.stack(axes, axis=-1).reshape(-1, 2)
    spots = spots[rng.permutation(len(spots))]
    for k in range(12):
        x, y = spots[k]
        size, yaw = rng.uniform(0.1, 0.5, 3), rng.uniform(-3, 3)
        mass = None if k % 2 else 4.0
        world.add_box(x, y, size[0], size[1], height=size[2], yaw=yaw, mass=mass)
    world.add_golf_ball(*spots[12])
    world.add_cart(*spots[13], 0.3, 0.4, travel=0.1, speed=0.1, yaw=0.3)
    yaws = rng.uniform(-np.pi, np.pi, 24)
    first = world.add_group(Pioneer2DX, np.column_stack([spots[14:26], yaws[:12]]))
    second = world.add_group(SoccerBot, np.column_stack([spots[26:38], yaws[12:]]))
    return world, first, second


def rectangle(x, y, yaw, half_length, half_width):
    """Corners (4, 2), anticlockwise."""
    corners = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * [half_length, half_width]
    c, s = np.cos(yaw), np.sin(yaw)
    return corners @ np.array([[c, s], [-s, c]]) + [x, y]


def to_edges(origin, heading, polygons, discs=()):
    """Ranges (b,) of rays from a point along headings (b,) to polygons' sides and to discs.

    Sides are intersected by Cramer's rule and discs (x, y, radius) by the angle at the origin:
    another way than the code under test goes.
    """
    best = np.full(len(heading), np.inf)
    ways = np.column_stack([np.cos(heading), np.sin(heading)])
    for polygon in polygons:
        for p, q in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
            side, start = q - p, p - origin
            det = ways[:, 1] * side[0] - ways[:, 0] * side[1]
            with np.errstate(divide="ignore", invalid="ignore"):
                t = (start[1] * side[0] - start[0] * side[1]) / det
                u = (ways[:, 0] * start[1] - ways[:, 1] * start[0]) / det
            hit = (t > 0) & (u >= 0) & (u <= 1)
            best = np.where(hit, np.minimum(best, t), best)
    for x, y, radius in discs:
        away = np.hypot(x - origin[0], y - origin[1])
        off = heading - np.arctan2(y - origin[1], x - origin[0])
        across = away * np.sin(off)
        hit = (np.abs(across) < radius) & (np.cos(off) > 0)
        depth = np.sqrt(np.maximum(radius**2 - across**2, 0.0))
        best = np.where(hit, np.minimum(best, away * np.cos(off) - depth), best)
    return best
