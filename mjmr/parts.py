"""Parts of a study that a user can swap by role, and what every one of a role must offer."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mjmr.errors import InvalidInputError, UnknownNameError


@dataclass(frozen=True, kw_only=True)
class Part:
    """A role in a study that another class can take.

    Args:
        role: Short name, for example ``"navigator"``.
        doc: What it does, one sentence.
        default: Dotted reference ``package.module:Class`` of the published one.
    """

    role: str
    doc: str
    default: str

    def __post_init__(self):
        if not self.role.isidentifier():
            raise InvalidInputError(f"a part's role must be an identifier, not {self.role!r}")


@dataclass(frozen=True)
class PartChoice:
    """What takes a role in a run; travels to workers by value.

    Args:
        role: The role.
        reference: Dotted reference ``package.module:Class``.
    """

    role: str
    reference: str


@dataclass(frozen=True)
class Job:
    """What a run computes trials of; travels to workers by value.

    Args:
        study: Name, or dotted reference ``module:attribute``, of the study.
        parts: What takes a role in place of the study's own.
    """

    study: str
    parts: tuple[PartChoice, ...] = ()


class Parts(Mapping[str, Any]):
    """The classes of a run by role; what a trial builds its parts with."""

    def __init__(self, declared: Sequence[Part], choices: Sequence[PartChoice] = ()):
        """Load every part.

        Args:
            declared: The study's parts.
            choices: What takes a role in place of its default.

        Raises:
            MjmrError: A reference leads nowhere.
        """
        from mjmr.study import resolve

        chosen = {c.role: c.reference for c in choices}
        self._classes = {p.role: resolve(chosen.get(p.role, p.default)) for p in declared}

    def __getitem__(self, role: str) -> Any:
        if role not in self._classes:
            raise UnknownNameError("part", role, self._classes)
        return self._classes[role]

    def __iter__(self) -> Iterator[str]:
        return iter(self._classes)

    def __len__(self) -> int:
        return len(self._classes)
