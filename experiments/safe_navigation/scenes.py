"""Scenes: where robots start and shuttle, on an F180 field.

The paper's field is 4.9 x 3.8 m with a 0.30 m border; obstacle shapes and goals are only in its
figures, so these are ours.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

REACH = 2.1  # goals lie at x = +-REACH [m]
_LANES = (1.2, 0.4, -0.4, -1.2)
# two that close and open the way in turn, and one that goes along it
_CARTS = {
    # their ways cross: carts meet, and a robot may be squeezed between them
    "carts": (
        (-0.7, 0.9, np.pi / 2, 0.5, 0.3, 1.2, 0.3),
        (0.7, -0.9, np.pi / 2, 0.5, 0.3, 1.2, 0.3),
        (0.0, 0.0, 0.0, 0.4, 0.3, 1.6, 0.3),
    ),
    # a robot fits between any two, and between each and the walls, wherever they are
    "carts-apart": (
        (-0.7, 1.15, np.pi / 2, 0.5, 0.3, 1.0, 0.3),
        (0.7, -1.15, np.pi / 2, 0.5, 0.3, 1.0, 0.3),
        (0.0, 0.0, 0.0, 0.4, 0.3, 1.6, 0.3),
    ),
}


@dataclass(frozen=True, kw_only=True)
class Scene:
    """Where robots start and shuttle.

    Attributes:
        starts: (n, 2) [m].
        far: First goals, (n, 2) [m].
        near: Second goals, (n, 2) [m]; then the first again, and so on.
        boxes: x, y, length, width [m].
        sees_robots: Whether the planner treats other robots as obstacles.
        samples: Accelerations the search draws.
        strangers: Robots that do not take part: each goes straight for its goals at 1 m/s.
        carts: x, y, yaw, length, width, travel [m, rad], speed [m/s].
    """

    starts: NDArray[np.float64]
    far: NDArray[np.float64]
    near: NDArray[np.float64]
    boxes: tuple[tuple[float, float, float, float], ...] = ()
    sees_robots: bool = True
    samples: int = 50
    strangers: tuple[int, ...] = ()
    carts: tuple[tuple[float, ...], ...] = ()


def scene(name: str) -> Scene:
    """The scene called ``name``; see the study's parameter."""
    if name == "A":
        boxes = ((0.0, 0.8, 0.8, 1.0), (0.0, -0.8, 0.8, 1.0), (1.2, 0.0, 0.6, 0.6))
        lanes = np.array(_LANES)
        return Scene(
            starts=_at(-REACH, lanes), far=_at(REACH, lanes), near=_at(-REACH, lanes), boxes=boxes
        )
    if name == "straight":
        return Scene(starts=_at(-REACH, [0.0]), far=_at(REACH, [0.0]), near=_at(-REACH, [0.0]))
    if name in _CARTS:
        lanes = np.array(_LANES)
        return Scene(
            starts=_at(-REACH, lanes),
            far=_at(REACH, lanes),
            near=_at(-REACH, lanes),
            carts=_CARTS[name],
        )
    ten = name in ("cross10", "stranger10")
    lanes = np.linspace(-1.8, 1.8, 10) if ten else np.array(_LANES)
    cross = Scene(
        starts=_at(-REACH, lanes),
        far=_at(REACH, -lanes),
        near=_at(-REACH, lanes),
        sees_robots=False,
        samples=100 if ten else 50,
        strangers=(4,) if name == "stranger10" else (),
    )
    if name == "overlap":
        starts = np.array([[-1.0, 0.5], [-0.88, 0.5], [0.0, -0.8], [0.08, -0.74]])
        return Scene(starts=starts, far=cross.far, near=cross.near, sees_robots=False)
    return cross


def _at(x: float, ys: Any) -> NDArray[np.float64]:
    return np.array([[x, y] for y in ys])
