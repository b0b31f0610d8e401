"""Draws what cannot be seen: goals, paths, planned commands, trails, names, clock."""

import colorsys

import cv2
import numpy as np
from numpy.typing import NDArray

from mjmr.geometry import Pinhole

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]
Rgb = tuple[int, int, int]
_CIRCLE = np.stack([np.cos(np.linspace(0, 2 * np.pi, 33)), np.sin(np.linspace(0, 2 * np.pi, 33))])
_FONT = cv2.FONT_HERSHEY_DUPLEX
_FAR = 1e6  # px
_LINK: Rgb = (255, 240, 150)
_SHIFT = 4  # cv2 takes sub-pixel coordinates as fixed point with this many bits


def palette(n: int) -> list[Rgb]:
    """N clearly different bright colours, 0 to 255."""
    hues = [(0.12 + k * 0.618034) % 1.0 for k in range(n)]
    return [
        tuple(round(255 * c) for c in colorsys.hsv_to_rgb(h, 0.55, 1.0))  # pyright: ignore
        for h in hues
    ]


def draw_line(
    picture: Picture, pixels: Array, colour: Rgb, thickness: int = 1, dashed: bool = False
) -> None:
    """Draw a polyline through pixels (k, 2); anything not finite or far outside is left out."""
    with np.errstate(invalid="ignore"):
        pixels = pixels[(np.abs(pixels) < _FAR).all(axis=-1)]
    if len(pixels) < 2:
        return
    pieces = _dashes(pixels) if dashed else pixels[None]
    fixed = np.round(pieces * (1 << _SHIFT)).astype(np.int32)
    cv2.polylines(picture, list(fixed), False, colour, thickness, cv2.LINE_AA, _SHIFT)


def _dashes(pixels: Array, period: float = 12.0) -> Array:
    """Pieces (m, 2, 2) of a polyline (k, 2): half of every ``period`` pixels of each segment."""
    pieces = []
    for a, b in zip(pixels[:-1], pixels[1:], strict=True):
        length = float(np.hypot(*(b - a)))
        starts = np.arange(0.0, length, period)
        ends = np.minimum(starts + period / 2, length)
        along = np.stack([starts, ends], axis=1) / max(length, 1e-9)
        pieces.append(a + along[..., None] * (b - a))
    return np.concatenate(pieces)


def draw_ring(
    picture: Picture, view: Pinhole, centre: Array, radius: float, colour: Rgb, thickness: int = 1
) -> None:
    """Draw a circle on the floor: centre (2,) and radius [m]."""
    if np.isfinite(centre).all():
        draw_line(picture, view.on_floor(centre + radius * _CIRCLE.T), colour, thickness)


def draw_text(
    picture: Picture, text: str, at: tuple[float, float], scale: float = 0.5,
    colour: Rgb = (255, 255, 255), align: str = "left",
) -> None:  # fmt: skip
    """Write a line with a dark rim; ``at`` is the baseline's left end, middle or right end [px]."""
    if not np.isfinite(at).all():
        return
    (width, _), _ = cv2.getTextSize(text, _FONT, scale, 1)
    x = at[0] - {"left": 0.0, "centre": width / 2, "right": float(width)}[align]
    origin = (round(x), round(at[1]))
    # a thicker stroke would be set wider, so the rim is the same text shifted
    for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1)):
        shifted = (origin[0] + dx, origin[1] + dy)
        cv2.putText(picture, text, shifted, _FONT, scale, (15, 15, 15), 1, cv2.LINE_AA)
    cv2.putText(picture, text, origin, _FONT, scale, colour, 1, cv2.LINE_AA)


def draw_notes(
    picture: Picture,
    view: Pinhole,
    poses: Array,
    radii: Array,
    notes: dict[str, Array],
    colours: list[Rgb],
) -> None:
    """Draw goals (rings), paths (dashed through the waypoint), stops (line and outline), links.

    Links are lines between robots, points are small rings.

    Args:
        picture: RGB, drawn into.
        view: Its camera.
        poses: Robots' poses (n, 3).
        radii: Robots' radii (n,) [m].
        notes: See :meth:`mjmr.loop.TickedSimulation.note`.
        colours: One a robot.
    """
    goals, waypoints = notes.get("goals"), notes.get("waypoints")
    stops, links, points = notes.get("stops"), notes.get("links"), notes.get("points")
    if links is not None:
        for i, j in np.argwhere(np.triu((links > 0) | (links > 0).T, 1)):
            draw_line(picture, view.on_floor(poses[[i, j], :2], z=0.1), _LINK, 1)
    if points is not None:
        for point in points:
            draw_ring(picture, view, point, 0.04, _LINK, 2)
    for i, colour in enumerate(colours):
        here = poses[i, :2]
        if goals is not None:
            draw_ring(picture, view, goals[i], 0.09, colour, 1)
            draw_ring(picture, view, goals[i], 0.015, colour, 2)
            route = [here, goals[i]]
            if waypoints is not None and np.isfinite(waypoints[i]).all():
                route.insert(1, waypoints[i])
                draw_ring(picture, view, waypoints[i], 0.015, colour, 2)
            draw_line(picture, view.on_floor(np.stack(route)), colour, 1, dashed=True)
        if stops is not None:
            draw_line(picture, view.on_floor(np.stack([here, stops[i]])), colour, 2)
            draw_ring(picture, view, stops[i], radii[i], colour, 1)


def draw_trails(
    picture: Picture,
    view: Pinhole,
    track: Array,
    colours: list[Rgb],
    lifts: NDArray[np.int64] | None = None,
) -> None:
    """Draw where robots have been: track (k, n, 2) [m], oldest first.

    ``lifts`` (k, n) counts how often each had been picked up: its trail is cut there.
    """
    for i, colour in enumerate(colours):
        faint: Rgb = tuple(c // 2 for c in colour)  # pyright: ignore[reportAssignmentType]
        cuts = [] if lifts is None else np.flatnonzero(np.diff(lifts[:, i])) + 1
        for piece in np.split(view.on_floor(track[:, i]), cuts):
            draw_line(picture, piece, faint, 1)
