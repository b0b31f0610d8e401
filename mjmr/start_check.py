"""Whether robots start inside each other, or inside what stands around."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from mjmr.errors import InvalidInputError

if TYPE_CHECKING:
    import mujoco

ALLOWED = 0.005  # m; wheels and props sink in a little when they rest


def check_start(model: "mujoco.MjModel", data: "mujoco.MjData", names: Sequence[str]) -> None:
    """Refuse a start in which a robot is deeper than ``ALLOWED`` in something else.

    Args:
        model: The compiled model.
        data: Its state, contacts computed.
        names: Of the robots; their bodies are called ``name/...``.

    Raises:
        InvalidInputError: Says which robots are in what, and how deep.
    """
    told = overlaps(model, data, names)
    if told:
        raise InvalidInputError(
            f"at the start these overlap: {told}; move them apart, or say World(overlap=True)"
        )


def overlaps(model: "mujoco.MjModel", data: "mujoco.MjData", names: Sequence[str]) -> str:
    """Which of these robots are deeper than ``ALLOWED`` in what, in words; empty if none is."""
    robots, worst = set(names), {}
    for contact in data.contact[: data.ncon]:
        if contact.dist > -ALLOWED:
            continue
        pair = sorted({_owner(model, int(geom)) for geom in contact.geom})
        # limbs of one robot may touch by construction
        if len(pair) == 2 and robots.intersection(pair):
            worst[tuple(pair)] = max(worst.get(tuple(pair), 0.0), -float(contact.dist))
    return ", ".join(f"{a} and {b} by {1e3 * d:.0f} mm" for (a, b), d in worst.items())


def _owner(model: Any, geom: int) -> str:
    """Robot or prop that a geom belongs to; of the world's own, the geom's name."""
    body = model.body(model.geom_bodyid[geom]).name
    return (model.geom(geom).name or body) if body == "world" else body.split("/")[0]
