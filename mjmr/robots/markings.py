"""Team colours, dot patterns and digits drawn with primitives."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mjmr.assets import model_path

if TYPE_CHECKING:
    import mujoco

_HALF_DISC = 0.0008  # m, half the thickness of the disc on top
Rgb = tuple[float, float, float]
Rgba = tuple[float, float, float, float]

# hues of 51, 222, 2 and 93 degrees; the bits' are 320 and 180, the carpet's 134, the ball's 23
TEAM_COLOURS: dict[str, Rgba] = {
    "yellow": (0.98, 0.85, 0.10, 1.0),
    "blue": (0.10, 0.35, 0.95, 1.0),
    "red": (0.90, 0.15, 0.12, 1.0),
    "green": (0.45, 0.90, 0.08, 1.0),
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


@dataclass(frozen=True, kw_only=True)
class DotPattern:
    """Dots on top of a robot: one in the team's colour, around it one for each bit of its code.

    Attributes:
        dots: Middles of the bits' dots (k, 2) [m], robot frame; the team's dot is at the origin.
        dot_radius: [m].
        centre_radius: Of the team's dot [m].
        height: Of the dots' upper faces above the floor [m].
        bit_colours: RGB of a 0 and of a 1, 0 to 1.
        team_colours: RGB by team.
        codes: Code of each number; bit k belongs to dot k.
    """

    dots: NDArray[np.float64]
    dot_radius: float
    centre_radius: float
    height: float
    bit_colours: tuple[Rgb, Rgb] = (_CYAN[:3], _PINK[:3])
    team_colours: dict[str, Rgb] = field(
        default_factory=lambda: {name: rgba[:3] for name, rgba in TEAM_COLOURS.items()}
    )
    codes: tuple[int, ...] = _PATTERNS

    def colours(self, number: int) -> list[Rgba]:
        """Colours of the bits' dots of robot ``number``; repeats after the last code."""
        code = self.codes[number % len(self.codes)]
        return [(*self.bit_colours[code >> k & 1], 1.0) for k in range(len(self.dots))]


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


def marked_model(
    name: str, number: int, team: str, *, disc: float, digit: float
) -> "mujoco.MjSpec":
    """A robot's model with its team's band and disc on top, and its number on the back.

    Args:
        name: Of the model, which has a material ``team``, a body ``base`` and sites ``top`` and
            ``back`` on it.
        number: Its last digit is shown.
        team: One of ``TEAM_COLOURS``.
        disc: Radius of the disc [m].
        digit: Height of the digit [m].
    """
    import mujoco

    spec = mujoco.MjSpec.from_file(str(model_path(name)))
    for key in list(spec.keys):
        spec.delete(key)
    rgba = TEAM_COLOURS[team]
    spec.material("team").rgba = rgba
    base = spec.body("base")
    base.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        pos=np.array(spec.site("top").pos) + [0.0, 0.0, _HALF_DISC],
        size=[disc, _HALF_DISC, 0],
        rgba=rgba,
        contype=0,
        conaffinity=0,
        group=1,
        mass=0,
    )
    draw_digit(spec.site("back"), base, number % 10, height=digit)
    return spec
