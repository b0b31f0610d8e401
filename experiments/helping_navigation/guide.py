"""Guide: the explorer's own planner on a real robot, fed by its scans alone."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.helping import RAYS, AvoidPast, PotentialField, Settings, visbug
from controllers.helping.visibility import sees
from controllers.mapping import ScanMap, free_ranges

Array = NDArray[np.float64]
_BODY, _KEPT = 0.32, 0.02  # m: disc that must be free where a planner wants to go, and short of it
_RANGE = 3.0  # m
_PATIENCE = 20  # motion steps that a target may be out of sight
_PLAN, _SEE = 0.36, 0.28  # m: walls grown for Bug2's path, and for what is in sight of it


class Guide:
    """Where to go when neither goal, offer nor mate leads.

    Avoid Past and the potential field get the free ways of the body along rays in the robot's own
    frame, as they do in the abstract trials. VisBug-21 gets a map, of which it needs no more than
    what it saw: the walls within its vision, as scans entered them so far. Bug2's path along them
    is planned again whenever they grow, along the same M-line, and the target stays where it was
    on it.
    """

    def __init__(self, planner: str, settings: Settings, size: Array, own: Any = None):
        """Args: planner: As the study names it. settings: Numbers. size: Of the office (2,) [m].

        own: A planner's class in place of the one named.
        """
        self.planner, self._settings = planner if own is None else "", settings
        if own is not None:
            self._by_rays: Any = own(settings, None, size)
        elif planner == "potential-field":
            self._by_rays = PotentialField(settings)
        else:
            self._by_rays = AvoidPast(settings, size=size)
        self._bug = visbug.bug()
        vision = settings.vision
        self._walls = ScanMap(radius=_PLAN, reach=vision + 0.5)
        self._sight = ScanMap(radius=_SEE, reach=vision + 0.5)
        self._edges: Any = None
        self._sight_edges = np.empty((0, 4))
        self._version = -1
        self._line: tuple[Array, Array] | None = None
        self._at, self._unseen = np.zeros(2), 0

    def new_goal(self) -> None:
        """Start afresh."""
        self._by_rays.begin()
        self._forget_line()

    def pause(self, pose: Array) -> None:
        """Something else leads at this step: VisBug draws a new M-line when it is asked again.

        Args:
            pose: Own (3,) in F_i.
        """
        self._by_rays.pause(pose[:2])
        self._forget_line()

    def _forget_line(self) -> None:
        self._line, self._unseen = None, 0

    def look(self, pose: Array, ranges: Array, angles: Array) -> None:
        """Remember what one sees.

        Args:
            pose: Own (3,) [m, m, rad] in F_i.
            ranges: Scan (b,) [m].
            angles: Of its beams (b,) [rad], body frame.
        """
        if self.planner == "visbug":
            self._walls.add(pose, ranges, angles)
            self._sight.add(pose, ranges, angles)

    def step(self, pose: Array, goal: Array, ranges: Array, angles: Array) -> Array:
        """Where to go now: a vector (2,) in the axes of F_i, in motion steps, no longer than one.

        Args:
            pose: Own (3,) in F_i.
            goal: (2,) [m] in F_i.
            ranges: Scan (b,) [m].
            angles: Of its beams (b,) [rad], body frame.
        """
        if self.planner == "visbug":
            way = self._follow_bug(pose[:2], goal) - pose[:2]
            return way / max(float(np.hypot(*way)), self._settings.step)
        free = free_ranges(
            ranges, np.cos(angles), np.sin(angles), RAYS - pose[2], _BODY, _RANGE + _KEPT
        )
        return self._by_rays.step(pose[:2], goal, np.maximum(free - _KEPT, 0.0))

    def _follow_bug(self, at: Array, goal: Array) -> Array:
        if self._line is None or self._version != self._walls.version:
            fresh = self._line is None or np.hypot(*(self._line[1] - goal)) > 0.5
            if fresh:
                self._line = at.copy(), goal.copy()
            assert self._line is not None
            if self._version != self._walls.version:
                self._edges = self._walls.edges()
                self._sight_edges = self._sight.edges()[0]
                self._version = self._walls.version
            edges, after, before = self._edges
            (x, y), (gx, gy) = self._line
            kept = self._progress()
            visbug.plan(self._bug, x, y, gx, gy, edges, after, before, self._settings.left)
            if not fresh:
                self._resume(kept)
        tx, ty = visbug.target(self._bug, at[0], at[1], self._settings.vision, self._sight_edges)
        self._at = np.array([tx, ty])
        # who made way for others may have strayed out of sight of its target: a new M-line then
        unseen = not sees(at[0], at[1], tx, ty, self._settings.vision, self._sight_edges)
        self._unseen = self._unseen + 1 if unseen else 0
        if self._unseen > _PATIENCE:
            self._forget_line()
        return self._at

    def _progress(self) -> float:
        """Length of the path up to the target [m]."""
        k = int(self._bug.at[1])
        way = np.diff(self._bug.path[: k + 1], axis=0)
        return float(np.hypot(*way.T).sum() + self._bug.offset[0])

    def _resume(self, length: float) -> None:
        """Put the target on a new path where the old one had it: near the same place, as far along.

        Args:
            length: Of the old path up to the target [m].
        """
        path = self._bug.path[: self._bug.at[0]]
        way = np.diff(path, axis=0)
        size = np.hypot(*way.T)
        ends = np.concatenate([[0.0], np.cumsum(size)])
        part = np.clip(
            ((self._at - path[:-1]) * way).sum(axis=1) / np.maximum(size, 1e-12) ** 2, 0.0, 1.0
        )
        off = np.hypot(*(path[:-1] + part[:, None] * way - self._at).T)
        along = ends[:-1] + part * size
        # the path passes some places twice: the one as far along as before counts
        k = int(np.argmin(off + 0.05 * np.abs(along - length)))
        self._bug.at[1], self._bug.offset[0] = k, part[k] * size[k]
