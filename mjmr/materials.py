"""What props and walls are made of, as far as sensors care."""

from mjmr.errors import UnknownNameError

MATERIALS = ("plain", "mirror", "black")
# return no light to where it came from: lidars and infra-red rangers see nothing there
DARK = ("mirror", "black")


def check_material(name: str) -> None:
    """Refuse what props and walls are not made of.

    Raises:
        UnknownNameError: Not one of ``MATERIALS``.
    """
    if name not in MATERIALS:
        raise UnknownNameError("material", name, MATERIALS)
