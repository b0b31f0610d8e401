"""Team colours, dot patterns and digits drawn with primitives."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import mujoco

Rgba = tuple[float, float, float, float]

TEAM_COLOURS: dict[str, Rgba] = {
    "yellow": (0.98, 0.85, 0.10, 1.0),
    "blue": (0.10, 0.35, 0.95, 1.0),
    "red": (0.90, 0.15, 0.12, 1.0),
    "green": (0.15, 0.75, 0.25, 1.0),
}
_PINK: Rgba = (1.0, 0.25, 0.75, 1.0)
_CYAN: Rgba = (0.10, 0.95, 0.95, 1.0)
# one bit a dot, chosen so that no pattern is a rotation of another with the open front unseen
_PATTERNS = (
    0b0000, 0b1111, 0b0001, 0b0010, 0b0100, 0b1000, 0b0011, 0b0110,
    0b1100, 0b1001, 0b0101, 0b1010, 0b0111, 0b1110, 0b1101, 0b1011,
)  # fmt: skip
# segments of a digit: top, upper left, upper right, middle, lower left, lower right, bottom
_SEGMENTS = ("1110111", "0010010", "1011101", "1011011", "0111010",
             "1101011", "1101111", "1010010", "1111111", "1111011")  # fmt: skip


def marker_colours(number: int) -> list[Rgba]:
    """Colours of the four dots around the centre for robot ``number`` (repeats after 16)."""
    bits = _PATTERNS[number % len(_PATTERNS)]
    return [_PINK if bits >> k & 1 else _CYAN for k in range(4)]


def draw_digit(site: "mujoco.MjsSite", body: "mujoco.MjsBody", digit: int, height: float) -> None:
    """Draw a digit from thin boxes in the plane x = 0 of the site's position, read from behind.

    Args:
        site: Where; the digit lies in the plane through it that faces backwards (-x).
        body: The body that carries it.
        digit: 0 to 9.
        height: Of the digit [m]; it is half as wide.
    """
    import mujoco

    half, thick = height / 4, height / 12
    # seen from behind, right is -y
    places = [
        (0.0, 2 * half, True),
        (half, half, False),
        (-half, half, False),
        (0.0, 0.0, True),
        (half, -half, False),
        (-half, -half, False),
        (0.0, -2 * half, True),
    ]
    origin = np.array(site.pos)
    for lit, (y, z, flat) in zip(_SEGMENTS[digit], places, strict=True):
        if lit == "1":
            size = [0.0015, half, thick / 2] if flat else [0.0015, thick / 2, half]
            body.add_geom(
                type=mujoco.mjtGeom.mjGEOM_BOX,
                pos=origin + [0.0, y, z],
                size=size,
                rgba=[0.95, 0.95, 0.95, 1],
                contype=0,
                conaffinity=0,
                group=1,
                mass=0,
            )
