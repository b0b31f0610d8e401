"""Where the MJCF files are: beside the packages in a checkout, inside mjmr in a wheel."""

from pathlib import Path

from mjmr.errors import UnknownNameError

_HERE = Path(__file__).resolve().parent


def asset_folder() -> Path:
    """Folder that holds one folder a robot."""
    packed = _HERE / "_assets"
    return packed if packed.is_dir() else _HERE.parent / "assets"


def model_path(robot: str) -> Path:
    """Path of a robot's MJCF file.

    Raises:
        UnknownNameError: No such robot; lists those there are.
    """
    path = asset_folder() / robot / f"{robot}.xml"
    if not path.is_file():
        raise UnknownNameError(
            "robot model", robot, sorted(p.parent.name for p in asset_folder().glob("*/*.xml"))
        )
    return path
