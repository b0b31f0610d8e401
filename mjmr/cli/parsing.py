"""Command lines from dataclasses by tyro, whose complaints become one sentence each."""

import contextlib
import io
import re
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import tyro
from tyro.conf import Positional, UseAppendAction, arg

from mjmr.errors import InvalidInputError

if TYPE_CHECKING:
    from mjmr.parts import PartChoice

T = TypeVar("T")

StudyName = Annotated[
    Positional[str], arg(metavar="STUDY", help="Name of the study; mjmr list names them.")
]
SizeName = Annotated[
    str,
    arg(metavar="SIZE", help="quick (seconds), standard (decides claims) or full (the paper's)."),
]


def option(metavar: str, text: str, default: str | None = None, name: str | None = None) -> Any:
    """Declare an option: what its value is called, what it means, the default in words, its name.

    The name is needed where it is not the field's.
    """
    hint = "" if default is None else f"(default: {default})"
    return arg(metavar=metavar, help=text, help_behavior_hint=hint, name=name)


PartTexts = Annotated[
    UseAppendAction[tuple[tuple[str, ...], ...]],
    option(
        "ROLE=REFERENCE",
        "Let another class take a role: package.module:Class or file.py:Class; repeatable.",
        "the published parts",
        name="with",
    ),
]


def part_choices(given: tuple[tuple[str, ...], ...]) -> "tuple[PartChoice, ...]":
    """What an option of type `PartTexts` chose.

    Raises:
        MjmrError: As for :func:`mjmr.part_sources.parse_choices`.
    """
    from mjmr.part_sources import parse_choices

    return parse_choices(text for texts in given for text in texts)


def parse(command: type[T], name: str, arguments: Sequence[str], more_help: str) -> T:
    """Read a command's arguments.

    Args:
        command: Dataclass whose docstring says what the command does.
        name: Name of the command.
        arguments: What follows it on the command line.
        more_help: Printed below the help: examples, files, exit codes.

    Raises:
        InvalidInputError: Arguments that are not understood.
        SystemExit: Help was asked for and printed.
    """
    prog = f"mjmr {name}"
    words = list(arguments)
    before_dashes = words[: words.index("--")] if "--" in words else words
    if {"-h", "--help"} & set(before_dashes):
        with contextlib.suppress(SystemExit):
            _tyro(command, prog, ["--help"])
        print("\n" + more_help.strip("\n"))
        raise SystemExit(0)
    complaint = io.StringIO()
    try:
        with contextlib.redirect_stderr(complaint):
            return _tyro(command, prog, words)
    except SystemExit:
        raise InvalidInputError(f"{_sentence(complaint.getvalue())}; see {prog} --help") from None


def whole_number(name: str, text: str | None, least: int = 1) -> int | None:
    """The number an option was given; None stays None.

    Raises:
        InvalidInputError: Not a whole number of at least ``least``.
    """
    if text is None:
        return None
    if not re.fullmatch(r"0*\d{1,9}", text, re.ASCII) or int(text) < least:
        raise InvalidInputError(f"{name} must be a whole number of at least {least}, not {text!r}")
    return int(text)


def check_file(path: Path) -> None:
    """Refuse a file that cannot be written, before anything is computed for it.

    Raises:
        InvalidInputError: Its folder is not there, or it is a folder itself.
    """
    if not path.parent.is_dir():
        raise InvalidInputError(f"cannot write {path}: there is no folder {path.parent}")
    if path.is_dir():
        raise InvalidInputError(f"cannot write {path}: it is a folder")


def show(text: Any, **options: Any) -> None:
    """Print something rich can lay out, as wide as the terminal, or 120 columns."""
    from mjmr.progress import standard_output

    standard_output().print(text, **options)


def _tyro(command: type[T], prog: str, words: list[str]) -> T:
    return tyro.cli(command, prog=prog, args=words, config=(tyro.conf.FlagCreatePairsOff,))


def _sentence(complaint: str) -> str:
    """What tyro says in a box, as one sentence."""
    lines = [re.sub(r"\x1b\[[0-9;]*m", "", line) for line in complaint.splitlines()]
    if lines and lines[0].startswith("╭"):
        inner = [line.strip("│") for line in lines[1:-1]]
    else:
        inner = lines[2:]  # where the terminal has no such characters: title, rule, the rest
    body = textwrap.dedent("\n".join(line for line in inner if line.strip())).splitlines()
    rules = [i for i, line in enumerate(body) if re.match(r"^\s*[─-]{3,}\s*$", line)]
    first = body[: rules[0]] if rules else body
    if first and first[0].strip().startswith("Missing from"):
        # Names are indented, their help more so.
        first = [line for line in first if len(line) - len(line.lstrip()) < 5]
    text = " ".join(" ".join(first).split()) or "the arguments are not understood"
    text = re.split(r" Got errors:", text)[0].rstrip(".")
    if rules and any("Perhaps you meant" in line for line in body):
        similar = re.findall(r"^\s+(--[\w-]+)", "\n".join(body[rules[0] :]), re.MULTILINE)
        text += f"; perhaps {' or '.join(dict.fromkeys(similar))}" if similar else ""
    return text[:1].lower() + text[1:]
