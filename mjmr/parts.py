"""Parts of a study that a user can swap by role, and what every one of a role must offer.

A part is chosen by a :class:`PartChoice`, which travels to workers by value: a dotted reference,
or the text of a file. mjmr/part_sources.py makes classes of choices, mjmr/part_guard.py holds
them to what the role demands.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mjmr.errors import InvalidInputError, UnknownNameError

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation

Shape = tuple[int | str, ...]


@dataclass(frozen=True, kw_only=True)
class Method:
    """A method every class of a role must have, or may have.

    Args:
        name: Its name.
        arguments: Names of its arguments, given by position.
        returns: Shape of the finite floats it returns; a name stands for the constructor argument
            of that name. None leaves it open what is returned.
        unit: Unit and frame of what is returned.
        optional: Whether a class may do without; one that has it must fit all the same.
        doc: When it is called and with what, for ``mjmr show``.
        check: What is demanded of the numbers beside their shape: ``package.module:function``,
            called with what is returned and the arguments; an
            :class:`~mjmr.errors.InvalidInputError` it raises is told as the part's.
    """

    name: str
    arguments: tuple[str, ...] = ()
    returns: Shape | None = None
    unit: str = ""
    optional: bool = False
    doc: str = ""
    check: str | None = None

    def __str__(self) -> str:
        text = f"{self.name}({', '.join(self.arguments)})"
        if self.returns is not None:
            text += f" -> {shape_text(self.returns)}"
            text += f" [{self.unit}]" if self.unit else ""
        return text


@dataclass(frozen=True, kw_only=True)
class Part:
    """A role in a study that another class can take.

    Args:
        role: Short name, for example ``"navigator"``.
        doc: What it does, one sentence.
        default: Dotted reference ``package.module:Class`` of the published one.
        constructor: Names of the constructor's arguments, given by position; None leaves them
            open.
        methods: What every class of this role has, or may have.
        optional: Attributes one may have beside, a sentence each.

    Raises:
        InvalidInputError: The declaration contradicts itself.
    """

    role: str
    doc: str
    default: str
    constructor: tuple[str, ...] | None = None
    methods: tuple[Method, ...] = ()
    optional: tuple[str, ...] = ()

    def __post_init__(self):
        if not self.role.isidentifier():
            raise InvalidInputError(f"a part's role must be an identifier, not {self.role!r}")
        for method in self.methods:
            for size in method.returns or ():
                if isinstance(size, str) and size not in (self.constructor or ()):
                    raise InvalidInputError(
                        f"part {self.role}: {method} has a size {size!r}, which is no argument of "
                        "the constructor"
                    )

    @property
    def interface(self) -> str:
        """What a class must offer, in one line."""
        told = [] if self.constructor is None else [f"__init__({', '.join(self.constructor)})"]
        return " and ".join([*told, *(str(m) for m in self.methods if not m.optional)])


@dataclass(frozen=True)
class PartChoice:
    """What takes a role in a run; travels to workers by value.

    Args:
        role: The role.
        reference: ``package.module:Class``, or ``path/to/file.py:Class`` as it was given.
        source: Text of the file; None for a dotted reference.
    """

    role: str
    reference: str
    source: str | None = None

    @property
    def name(self) -> str:
        """Name of the class."""
        return self.reference.rpartition(":")[2]

    def __str__(self) -> str:
        return f"{self.role}={self.reference}"


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
    """The classes of a run by role; what a trial builds its parts with.

    A class that took a role comes guarded: what its methods return is checked at every call. The
    study's own comes as it is.
    """

    def __init__(self, declared: Sequence[Part], choices: Sequence[PartChoice] = ()):
        """Load every part.

        Args:
            declared: The study's parts.
            choices: What takes a role in place of its default.

        Raises:
            MjmrError: A reference leads nowhere, or to what cannot take the role.
        """
        from mjmr.study import resolve

        self._simulation: TickedSimulation | None = None
        chosen = {c.role: c for c in choices}
        self._classes = {
            p.role: self._guarded(p, chosen[p.role]) if p.role in chosen else resolve(p.default)
            for p in declared
        }

    def _guarded(self, part: Part, choice: PartChoice) -> Callable[..., Any]:
        from mjmr.part_guard import Guard, check
        from mjmr.part_sources import load

        loaded = load(choice)
        check(part, choice.reference, loaded)
        return lambda *arguments: Guard(part, choice.reference, loaded, arguments, self.when)

    def watch(self, simulation: "TickedSimulation") -> None:
        """Take the time that errors name from ``simulation``; a watcher of mjmr/watch.py."""
        self._simulation = simulation

    def when(self) -> str:
        """The present tick and time in words; empty if no simulation is watched."""
        simulation = self._simulation
        if simulation is None:
            return ""
        time = simulation.time
        return f"at tick {round(time / simulation.control_period)} ({time:.3f} s)"

    def __getitem__(self, role: str) -> Any:
        if role not in self._classes:
            raise UnknownNameError("part", role, self._classes)
        return self._classes[role]

    def __iter__(self) -> Iterator[str]:
        return iter(self._classes)

    def __len__(self) -> int:
        return len(self._classes)


def shape_text(shape: Shape) -> str:
    """A shape as Python writes it, names without quotes: ``(n, 2)``."""
    return f"({', '.join(map(str, shape))}{',' if len(shape) == 1 else ''})"
