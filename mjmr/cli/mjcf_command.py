"""``mjmr mjcf``."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from tyro.conf import Positional

from mjmr.cli.parsing import StudyName, option, parse
from mjmr.errors import InvalidInputError, MjmrError

_MORE = """
EXAMPLES
  mjmr mjcf safe-navigation model.xml
  mjmr mjcf safe-navigation model.xml scene=cross4 mode=physical

EXIT CODES
  0  the file was written
  2  bad input, a study without a world, or a file that cannot be written
"""


@dataclass(frozen=True)
class Mjcf:
    """Write the MuJoCo model of one condition as a single MJCF file.

    MuJoCo's own viewer and any other tool can open it. An existing file is replaced.
    """

    study: StudyName
    file: Annotated[Positional[Path], option("FILE.xml", "File to write.")]
    condition: Annotated[
        Positional[tuple[str, ...]],
        option("KEY=VALUE", "Values of the condition; mjmr show STUDY lists them.", "defaults"),
    ] = ()


def main(arguments: Sequence[str]) -> int:
    """Write a condition's model."""
    a = parse(Mjcf, "mjcf", arguments, _MORE)
    if "=" in a.file.name and not a.file.suffix:
        raise InvalidInputError(
            f"the file comes before the condition: mjmr mjcf {a.study} FILE.xml {a.file}"
        )
    from mjmr.conditions import parse_condition
    from mjmr.files import write_atomically
    from mjmr.registry import load_study
    from mjmr.study_calls import call_study

    study = load_study(a.study)
    condition = parse_condition(study.parameters, a.condition)
    build = study.resolve("world")
    if build is None:
        raise MjmrError(f"study {study.name} declares no world")
    text = call_study("world", lambda: build(condition).to_xml())
    try:
        write_atomically(a.file, text)
    except OSError as e:
        raise MjmrError(f"cannot write {a.file}: {e.strerror}") from e
    return 0
