"""Where the MJCF files are: beside the packages in a checkout, inside mjmr in a wheel."""

from pathlib import Path

from mjmr.errors import UnknownNameError

_HERE = Path(__file__).resolve().parent


def asset_folder() -> Path:
    """Folder that holds one folder a robot."""
    packed = _HERE / "_assets"
    return packed if packed.is_dir() else _HERE.parent / "assets"


def model_path(robot: str, variant: str = "") -> Path:
    """Path of a robot's MJCF file.

    Args:
        robot: Its folder's name.
        variant: Of the model, for robots that have several: ``<robot>_<variant>.xml``.

    Raises:
        UnknownNameError: No such robot; lists those there are.
    """
    name = f"{robot}_{variant}" if variant else robot
    path = asset_folder() / robot / f"{name}.xml"
    if not path.is_file():
        models = (
            p.stem for p in asset_folder().glob("*/*.xml") if p.stem.startswith(p.parent.name)
        )
        raise UnknownNameError("robot model", name, sorted(models))
    return path
