"""Where ray-based sensors are: named sites of a robot's model, or a site added to it."""

from typing import TYPE_CHECKING

from mjmr.errors import InvalidInputError, UnknownNameError

if TYPE_CHECKING:
    import mujoco


def site_names(spec: "mujoco.MjSpec", prefix: str) -> list[str]:
    """Names of a robot's sites, without its prefix."""
    return [s.name.removeprefix(prefix) for s in spec.sites if s.name.startswith(prefix)]


def require_site(spec: "mujoco.MjSpec", prefix: str, name: str) -> None:
    """Check that a robot has a site.

    Raises:
        UnknownNameError: It has none of that name; lists those it has.
    """
    names = site_names(spec, prefix)
    if name not in names:
        raise UnknownNameError("site of the robot's model", name, names)


def numbered_sites(spec: "mujoco.MjSpec", prefix: str, stem: str) -> list[str]:
    """A robot's sites called ``stem`` and a number, in the numbers' order.

    Raises:
        UnknownNameError: There is none; lists the stems there are.
    """
    names = site_names(spec, prefix)
    found = [n for n in names if n.removeprefix(stem).isdecimal() and n.startswith(stem)]
    if not found:
        stems = dict.fromkeys(n.rstrip("0123456789") for n in names if n[-1:].isdecimal())
        raise UnknownNameError("array of sites of the robot's model", stem, stems)
    return sorted(found, key=lambda n: int(n.removeprefix(stem)))


def base_body(spec: "mujoco.MjSpec", prefix: str) -> "mujoco.MjsBody":
    """A robot's first body."""
    for body in spec.bodies:
        if body.name.startswith(prefix) and body.name != "world":
            return body
    raise InvalidInputError(f"there is no robot called {prefix!r} in this model")
