"""Discs on a plane, compiled: motion that walls, blocks and other robots block, and detectors.

Legitimately abstract: no mass, no friction, no wheels. A robot that would overlap something is put
out of it along the contact's normal, so that it slides; where that is not possible it stays.
"""

import math

import numpy as np

from mjmr.jit import njit

_FRONT = math.pi / 2  # bearing up to which the bumper reaches, either side
_MIDDLE = math.radians(15.0)  # a hit nearer to straight ahead presses both halves
_ROUNDS = 4
_EPS = 1e-9


@njit
def _press(bump, i, bearing):
    """Note a hit at a bearing [rad] of robot i."""
    b = np.pi - (np.pi - bearing) % (2.0 * np.pi)
    if abs(b) <= _FRONT:
        if b > -_MIDDLE:
            bump[i, 0] = True
        if b < _MIDDLE:
            bump[i, 1] = True


@njit
def advance(pose, present, command, blocks, size, radius, dt, steps, bump, way):
    """Drive every robot that is present for ``steps`` times ``dt``.

    Args:
        pose: (n, 3) [m, m, rad]; changed.
        present: (n,).
        command: v [m/s], w [rad/s], held (n, 2).
        blocks: Corners (k, 4) [m].
        size: Side of the arena [m].
        radius: Of a robot [m].
        dt: [s].
        steps: How many.
        bump: Set where a front bumper is pressed, left and right (n, 2).
        way: Path lengths, added to (n,) [m].
    """
    n = len(pose)
    for _ in range(steps):
        for i in range(n):
            if not present[i]:
                continue
            v, w = command[i, 0], command[i, 1]
            if v == 0.0 and w == 0.0:
                continue
            x0, y0 = pose[i, 0], pose[i, 1]
            middle = pose[i, 2] + 0.5 * w * dt
            pose[i, 2] += w * dt
            if v == 0.0:
                continue
            x, y = x0 + v * dt * np.cos(middle), y0 + v * dt * np.sin(middle)
            free = False
            for _ in range(_ROUNDS):
                free = True
                for axis in range(2):
                    at = x if axis == 0 else y
                    low, high = radius, size - radius
                    if at < low - _EPS or at > high + _EPS:
                        free = False
                        side = np.pi if at < low else 0.0
                        _press(bump, i, side + axis * (np.pi / 2.0) - pose[i, 2])
                        at = min(max(at, low), high)
                        if axis == 0:
                            x = at
                        else:
                            y = at
                for k in range(len(blocks)):
                    px = min(max(x, blocks[k, 0]), blocks[k, 2])
                    py = min(max(y, blocks[k, 1]), blocks[k, 3])
                    dx, dy = x - px, y - py
                    d = np.sqrt(dx * dx + dy * dy)
                    if _EPS < d < radius - _EPS:
                        free = False
                        _press(bump, i, np.arctan2(-dy, -dx) - pose[i, 2])
                        x, y = px + dx / d * radius, py + dy / d * radius
                for j in range(n):
                    if j == i or not present[j]:
                        continue
                    dx, dy = x - pose[j, 0], y - pose[j, 1]
                    d = np.sqrt(dx * dx + dy * dy)
                    if _EPS < d < 2.0 * radius - _EPS:
                        free = False
                        toward = np.arctan2(-dy, -dx)
                        _press(bump, i, toward - pose[i, 2])
                        _press(bump, j, toward + np.pi - pose[j, 2])
                        x = pose[j, 0] + dx / d * 2.0 * radius
                        y = pose[j, 1] + dy / d * 2.0 * radius
                if free:
                    break
            if not free:  # wedged: stay
                x, y = x0, y0
            way[i] += np.sqrt((x - x0) ** 2 + (y - y0) ** 2)
            pose[i, 0], pose[i, 1] = x, y


@njit
def _ray_box(x, y, c, s, x0, y0, x1, y1):
    """Distance along a ray into a box from outside; infinite if it misses."""
    low, high = 0.0, np.inf
    for axis in range(2):
        o, d = (x, c) if axis == 0 else (y, s)
        a, b = (x0, x1) if axis == 0 else (y0, y1)
        if abs(d) < 1e-12:
            if o < a or o > b:
                return np.inf
        else:
            t0, t1 = (a - o) / d, (b - o) / d
            if t0 > t1:
                t0, t1 = t1, t0
            low, high = max(low, t0), min(high, t1)
    return low if low <= high else np.inf


@njit
def tripped(pose, present, blocks, size, radius, trip, bearings, fan, seen):
    """Whether each detector has something within its threshold.

    Args:
        pose: (n, 3).
        present: (n,); absent robots neither see nor are seen.
        blocks: (k, 4) [m].
        size: [m].
        radius: Of a robot; detectors sit on its rim [m].
        trip: Threshold [m].
        bearings: Of the detectors on the rim (2,) [rad].
        fan: Directions of their rays, from straight outwards (r,) [rad].
        seen: Written (n, 2).
    """
    n = len(pose)
    for i in range(n):
        for e in range(2):
            seen[i, e] = False
            if not present[i]:
                continue
            out = pose[i, 2] + bearings[e]
            x, y = pose[i, 0] + radius * np.cos(out), pose[i, 1] + radius * np.sin(out)
            for f in range(len(fan)):
                c, s = np.cos(out + fan[f]), np.sin(out + fan[f])
                ex, ey = x + trip * c, y + trip * s
                if ex < 0.0 or ey < 0.0 or ex > size or ey > size:
                    seen[i, e] = True
                for k in range(len(blocks)):
                    if seen[i, e]:
                        break
                    b = blocks[k]
                    if _ray_box(x, y, c, s, b[0], b[1], b[2], b[3]) <= trip:
                        seen[i, e] = True
                for j in range(n):
                    if seen[i, e]:
                        break
                    if j == i or not present[j]:
                        continue
                    ox, oy = pose[j, 0] - x, pose[j, 1] - y
                    along = ox * c + oy * s
                    if ox * ox + oy * oy > (trip + radius) ** 2 or along < 0.0:
                        continue
                    across2 = ox * ox + oy * oy - along * along
                    if (
                        across2 <= radius * radius
                        and along - np.sqrt(radius * radius - across2) <= trip
                    ):
                        seen[i, e] = True
