"""``mjmr robots``."""

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from tyro.conf import Positional

from mjmr.cli.parsing import check_file, option, parse, show
from mjmr.errors import GL_ADVICE, InvalidInputError, MissingGLError, MjmrError

if TYPE_CHECKING:
    from mjmr.robots.facts import Facts
    from mjmr.robots.platform import Platform

_STUDY = "proving-ground"  # whose committed figures are shown
_MORE = """
EXAMPLES
  mjmr robots
  mjmr robots pioneer2dx
  mjmr robots pioneer2dx --view
  mjmr robots soccer_bot --view --out soccer_bot.png

Sizes are those of the collision geometry, masses and mounts those of the compiled model. Figures
are measured by the study proving-ground. Grades: A fitted to published measurements, B data sheet,
C plausible.

EXIT CODES
  0  done
  1  a robot could not be compiled, or there is no off-screen OpenGL
  2  no such robot (the valid names are listed), or a file that cannot be written
"""


@dataclass(frozen=True)
class Robots:
    """List the robots, or show one: numbers with their sources, limits, sensors, a picture.

    The picture is a contact sheet: front, side, top and what the robot's own camera sees.
    """

    robot: Annotated[Positional[str | None], option("NAME", "Name of the robot.", "all")] = None
    view: Annotated[bool, option("", "Make a contact sheet, a PNG.", "none")] = False
    out: Annotated[
        Path | None, option("FILE", "File of the contact sheet.", "renders/robots/NAME.png")
    ] = None


def main(arguments: Sequence[str]) -> int:
    """Print a table of robots, or one robot, or make its picture."""
    a = parse(Robots, "robots", arguments, _MORE)
    if a.out is not None and not a.view:
        raise InvalidInputError("--out names the file of the contact sheet; it takes --view")
    if a.robot is None:
        if a.view:
            raise InvalidInputError("--view takes the name of a robot: mjmr robots NAME --view")
        return _list()
    from mjmr.robots import platform_class

    platform = platform_class(a.robot)()
    if a.view:
        return _view(a.robot, platform, a.out)
    _show(a.robot, platform)
    return 0


def _list() -> int:
    from rich.table import Table
    from rich.text import Text

    from mjmr.robots import PLATFORMS, platform_class
    from mjmr.robots.facts import collapse, facts, stage

    measured = _measured()
    table = Table(show_lines=True)
    for header in ("robot", "size m", "mass kg", "top speed", "commands", "sensors", "mounts"):
        table.add_column(header, overflow="fold")
    table.columns[0].min_width = max(map(len, PLATFORMS))
    table.add_column("grade", justify="center")
    if measured:
        header = f"measured ({_STUDY})"
        table.add_column(header, overflow="fold", min_width=len(header))
    broken = []
    for name in PLATFORMS:
        try:
            f = facts(stage(platform_class(name)()))
        except MjmrError as e:
            broken.append(f"mjmr: {name}: {e}")
            continue
        p = f.platform
        cells = [f"{name}\n{p.title}", _size(f), f"{f.mass:.3g}", _speed(p)]
        cells += [
            _names(p.command_names),
            _sensors(p),
            collapse(dict.fromkeys([*f.sites, *f.cameras])),
        ]
        cells.append(p.grade)
        if measured:
            told = measured.get(name, {})
            cells.append("\n".join(f"{figure}: {value}" for figure, value in told.items()))
        table.add_row(*map(Text, cells))
    show(table)
    for line in broken:
        print(line, file=sys.stderr)
    return 1 if broken else 0


def _show(name: str, platform: "Platform") -> None:
    from rich.table import Table
    from rich.text import Text

    from mjmr.robots.facts import collapse, facts, number_tables, stage

    f = facts(stage(platform))
    show(Text(f"{name}: {platform.title}", "bold"))
    rows = {
        "grade": platform.grade,
        "size": f"{_size(f)} m",
        "mass": f"{f.mass:.3g} kg",
        "top speed": _speed(platform),
        "drive follows": _limits(platform),
        "emergency stop": f"{platform.braking:g} m/s^2",
        "commands": _commands(platform),
        "sensors": _sensors(platform),
        "sites": collapse(f.sites) or "none",
        "cameras": collapse(f.cameras) or "none",
    }
    table = Table(show_header=False)
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    for key, value in rows.items():
        table.add_row(key, Text(value))
    show(table)
    for heading, (header, *lines) in number_tables(platform.name):
        show(Text(f"\n{heading}"))
        numbers = Table()
        for column in header:
            numbers.add_column(column, overflow="fold")
        for line in lines:
            numbers.add_row(*map(Text, line))
        show(numbers)
    figures = _measured().get(name)
    if figures:
        show(Text(f"\nMeasured ({_STUDY})"))
        table = Table(show_header=False)
        for figure, value in figures.items():
            table.add_row(Text(figure), Text(value))
        show(table)


def _view(name: str, platform: "Platform", out: Path | None) -> int:
    path = out or Path("renders") / "robots" / f"{name}.png"
    try:
        if out is None:
            path.parent.mkdir(parents=True, exist_ok=True)
        check_file(path)
        import cv2

        from mjmr.files import write_atomically
        from mjmr.robots.contact_sheet import contact_sheet

        sheet = contact_sheet(platform)
        _, png = cv2.imencode(".png", sheet[..., ::-1])
        write_atomically(path, png.tobytes())
    except MissingGLError:
        print(f"mjmr: {GL_ADVICE}", file=sys.stderr)
        return 1
    except OSError as e:
        raise MjmrError(f"cannot write {path}: {e.strerror}") from e
    print(f"contact sheet: {path}")
    return 0


def _measured() -> dict[str, dict[str, str]]:
    """Figures by robot, ``{figure: text}``; none where the study is not installed."""
    from mjmr.registry import load_study, study_references

    if _STUDY not in study_references():
        return {}
    try:
        return load_study(_STUDY).committed_figures()
    except MjmrError as e:
        print(f"mjmr: {_STUDY}: {e}", file=sys.stderr)
        return {}


def _size(f: "Facts") -> str:
    return " x ".join(f"{v:.2f}" for v in f.size)


def _names(names: Sequence[str]) -> str:
    few = names if len(names) <= 4 else (f"{len(names)}: {names[0]}", "...", names[-1])
    return ", ".join(few)


def _speed(platform: "Platform") -> str:
    speed, rate = platform.max_twist
    return f"{speed:g} m/s, {math.degrees(rate):.0f} deg/s"


def _limits(platform: "Platform") -> str:
    limits: Any = platform.limits
    return (
        f"{limits.max_speed:.3g} m/s, speeds up by {limits.acceleration:.3g} and slows down by "
        f"{limits.deceleration:.3g} m/s^2"
    )


def _commands(platform: "Platform") -> str:
    low, high = platform.command_bounds
    columns = zip(platform.command_names, low, high, strict=True)
    return ", ".join(f"{name} {a:.3g} to {b:.3g}" for name, a, b in columns)


def _sensors(platform: "Platform") -> str:
    told = [f"{name} ({s.rate:g} Hz)" for name, s in platform.default_sensors().items()]
    return ", ".join(told) or "none"
