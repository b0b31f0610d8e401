"""A study: the declaration of a published system's experiment, cheap to import.

What is heavy (the trial, claims, film, plots, world) is named by a dotted reference
``"package.module:attribute"`` and imported when first used, so that listing studies loads nothing.
"""

import dataclasses
import functools
import hashlib
import importlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mjmr.conditions import (
    Condition,
    Filter,
    Grid,
    Parameter,
    complete,
    find_parameter,
    format_value,
    matches,
)
from mjmr.errors import InvalidInputError, MjmrError, UnknownNameError, one_line
from mjmr.parts import Part, PartChoice, Parts
from mjmr.watch import watching

if TYPE_CHECKING:
    from mjmr.claims import Claim

Reference = str | Callable[..., Any]
Trial = tuple[Condition, int]


@dataclass(frozen=True)
class Size:
    """How much of a study is run.

    Args:
        name: ``quick``, ``standard`` or ``full``.
        grids: The conditions.
        default_seeds: Seeds of a grid that names no number of its own; seeds are 0 .. N-1.
        expected_minutes: Wall time on two cores with warm caches [min].
        note: What this size leaves out, if anything.
    """

    name: str
    grids: tuple[Grid, ...]
    default_seeds: int
    expected_minutes: float
    note: str = ""

    def __post_init__(self):
        object.__setattr__(self, "grids", tuple(self.grids))
        if not self.grids or self.default_seeds < 1 or not self.expected_minutes > 0:
            raise InvalidInputError(
                f"size {self.name}: grids, default_seeds and expected_minutes must be positive"
            )


@dataclass(frozen=True, kw_only=True)
class Study:
    """A published system's experiment.

    Args:
        name: As on the command line.
        title: One line.
        paper: Citation.
        summary: What is reproduced and how, a paragraph.
        parameters: Everything a condition names.
        sizes: ``quick``, ``standard`` and ``full``.
        trial: ``(condition, seed) -> dict`` of float, int, str, bool or None. The same condition
            and seed give the same bits, except for names that start with ``wall_``: wall-clock
            times, kept in a table of their own. ``MissingGLError`` marks the trial ``no-gl``.
        claims: ``() -> list[Claim]``, or the list.
        film: ``(study, path, options) -> None``: writes H.264 to ``path``; the options are a
            :class:`mjmr.film_options.FilmOptions`.
        plots: ``(table, folder) -> list of paths``: writes SVG files into ``folder``.
        world: ``(condition) -> object`` with ``to_xml() -> str``, for ``mjmr mjcf``.
        bench: ``() -> str | Mapping``: measures speed, for ``mjmr bench``.
        prepare: ``() -> None``: compiles what the trials need, in the driver, before workers start.
        verdicts: The committed ``verdicts.json``.
        figures: Committed JSON of what was measured on each robot, ``{robot: {figure: text}}``,
            for ``mjmr robots``.
        source_packages: Packages whose source makes a result what it is; None means mjmr,
            controllers and the package the trial is in. With ``mjmr`` the models are counted too.
        parts: Roles another class can take; if there are any, the trial is called with a third
            argument, the :class:`mjmr.parts.Parts` of the run.
        chosen: What takes a role in place of its default; see :meth:`choose`.

    Raises:
        InvalidInputError: The declaration contradicts itself.
    """

    name: str
    title: str
    paper: str
    summary: str
    parameters: tuple[Parameter, ...]
    sizes: tuple[Size, ...]
    trial: Reference
    claims: "Reference | Sequence[Claim]" = ()
    film: Reference | None = None
    plots: Reference | None = None
    world: Reference | None = None
    bench: Reference | None = None
    prepare: Reference | None = None
    verdicts: Path | None = None
    figures: Path | None = None
    source_packages: tuple[str, ...] | None = None
    parts: tuple[Part, ...] = ()
    chosen: tuple[PartChoice, ...] = ()

    def __post_init__(self):
        object.__setattr__(self, "parameters", tuple(self.parameters))
        object.__setattr__(self, "sizes", tuple(self.sizes))
        for kind, names in (
            ("parameter", [p.name for p in self.parameters]),
            ("size", [s.name for s in self.sizes]),
            ("part", [p.role for p in self.parts]),
        ):
            if len(set(names)) < len(names):
                raise InvalidInputError(f"study {self.name}: a {kind} is declared twice: {names}")
        if not self.sizes:
            raise InvalidInputError(f"study {self.name}: no sizes")

    def size(self, name: str) -> Size:
        """The size called ``name``.

        Raises:
            UnknownNameError: There is none; lists those there are.
        """
        for size in self.sizes:
            if size.name == name:
                return size
        raise UnknownNameError("size", name, [s.name for s in self.sizes])

    def trials(
        self, size: str, seeds: int | None = None, only: Filter | None = None
    ) -> list[Trial]:
        """The trials of a size: each (condition, seed) once, in a fixed order.

        Within a grid all conditions come with seed 0, then with seed 1, and so on, so that an
        interrupted run has covered every condition evenly.

        Args:
            size: Name of the size.
            seeds: Number of seeds of every condition; None takes what the size declares.
            only: Keep conditions that have one of these values for each name.

        Raises:
            UnknownNameError: An unknown size, name or value.
            InvalidInputError: Seeds below 1, or nothing is left.
        """
        declared = self.size(size)
        if seeds is not None and seeds < 1:
            raise InvalidInputError(f"seeds must be at least 1, not {seeds}")
        wanted = {
            name: tuple(find_parameter(self.parameters, name).check(v) for v in values)
            for name, values in (only or {}).items()
        }
        found: dict[Trial, None] = {}
        for grid in declared.grids:
            conditions = grid.conditions(self.parameters)
            kept = [c for c in conditions if matches(c, wanted)]
            for seed in range(seeds or grid.seeds or declared.default_seeds):
                found.update({(condition, seed): None for condition in kept})
        if not found:
            told = " ".join(f"{n}={','.join(map(format_value, v))}" for n, v in wanted.items())
            raise InvalidInputError(f"size {size} of {self.name} has no condition with {told}")
        return list(found)

    def condition(self, **given: Any) -> Condition:
        """A complete condition, defaults filled in."""
        return complete(self.parameters, given)

    def resolve(self, role: str) -> Any:
        """What a field such as ``trial`` refers to; None if the study has none.

        Raises:
            MjmrError: The reference leads nowhere.
        """
        return resolve(getattr(self, role))

    def choose(self, choices: Sequence[PartChoice]) -> "Study":
        """This study with other classes in some of its roles, loaded and checked.

        Raises:
            UnknownNameError: A choice for a role that is not declared; lists those there are.
            PartError: A class that cannot be loaded or cannot take its role.
        """
        roles = [part.role for part in self.parts]
        for choice in choices:
            if not roles:
                raise InvalidInputError(
                    f"study {self.name} declares no parts, so {choice} has nothing to take"
                )
            if choice.role not in roles:
                raise UnknownNameError("part", choice.role, roles)
        taken = {choice.role for choice in choices}
        Parts([part for part in self.parts if part.role in taken], choices)
        return dataclasses.replace(self, chosen=tuple(choices))

    @property
    def swapped(self) -> str:
        """What was swapped, for titles: ``", with ROLE=REFERENCE"`` for each; empty if nothing."""
        return "".join(f", with {choice}" for choice in self.chosen)

    def bound_trial(self) -> Callable[..., Any]:
        """The trial as ``(condition, seed) -> metrics``, with its parts bound to it.

        Raises:
            MjmrError: A reference leads nowhere.
        """
        function = self.resolve("trial")
        if not self.parts:
            return function
        if not self.chosen:
            return functools.partial(function, parts=Parts(self.parts))

        def watched(condition: Condition, seed: int) -> Any:
            parts = Parts(self.parts, self.chosen)
            with watching(parts.watch):  # errors of a part name tick and time
                return function(condition, seed, parts=parts)

        return watched

    def load_claims(self) -> "list[Claim]":
        """The claims.

        Raises:
            InvalidInputError: An id occurs twice, or a size that decides a claim is not declared.
        """
        found = self.resolve("claims")
        claims: list[Claim] = [*(found() if callable(found) else found)]  # pyright: ignore
        ids = [claim.id for claim in claims]
        if len(set(ids)) < len(ids):
            raise InvalidInputError(f"study {self.name}: a claim id occurs twice: {ids}")
        for claim in claims:
            for size in claim.sizes:
                self.size(size)
        return claims

    def committed_verdicts(self) -> dict[str, dict[str, str]]:
        """The committed verdicts as ``{size: {claim id: verdict}}``; empty if there is no file.

        Raises:
            MjmrError: The file is not of this form.
        """
        if self.verdicts is None or not self.verdicts.exists():
            return {}
        try:
            found = json.loads(self.verdicts.read_text())
            return {size: dict(verdicts) for size, verdicts in found.items()}
        except (OSError, ValueError, AttributeError, TypeError) as e:
            raise MjmrError(f"cannot read committed verdicts {self.verdicts}: {e}") from e

    def committed_figures(self) -> dict[str, dict[str, str]]:
        """What was measured on each robot, ``{robot: {figure: text}}``; empty if there is no file.

        Raises:
            MjmrError: The file is not of this form.
        """
        if self.figures is None or not self.figures.exists():
            return {}
        try:
            found = json.loads(self.figures.read_text())
            return {r: {k: str(v) for k, v in told.items()} for r, told in found.items()}
        except (OSError, ValueError, AttributeError) as e:
            raise MjmrError(f"cannot read committed figures {self.figures}: {e}") from e

    def digest(self, size: str) -> str:
        """SHA-256 of all a result of this size depends on: declaration, sources, versions.

        Parts that were chosen count with their source.
        """
        from mjmr.part_sources import choice_digest
        from mjmr.provenance import source_digest, versions

        declared = self.size(size)
        packages = self.source_packages
        if packages is None:
            packages = ("mjmr", "controllers", self.package)
        parts = {
            "study": self.name,
            "trial": self.trial if isinstance(self.trial, str) else _reference(self.trial),
            "parameters": [repr(p) for p in self.parameters],
            "size": [declared.name, declared.default_seeds, [repr(g) for g in declared.grids]],
            "sources": source_digest(*packages) if packages else "",
            "assets": _asset_digest() if "mjmr" in packages else "",
            "versions": versions(),
            "chosen": sorted(choice_digest(choice) for choice in self.chosen),
        }
        return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()

    @property
    def package(self) -> str:
        """Package the trial is in."""
        trial = self.trial if isinstance(self.trial, str) else _reference(self.trial)
        module = trial.partition(":")[0]
        return module.rpartition(".")[0] or module


def resolve(reference: Any) -> Any:
    """The object a dotted reference names; anything else is returned as it is.

    Raises:
        InvalidInputError: Not of the form ``package.module:attribute``.
        MjmrError: Module or attribute is not there, or importing it fails.
    """
    if not isinstance(reference, str):
        return reference
    module, colon, attribute = reference.partition(":")
    if not (module and colon and attribute):
        raise InvalidInputError(f"expected package.module:attribute, not {reference!r}")
    try:
        return getattr(importlib.import_module(module), attribute)
    except MjmrError:
        raise
    except Exception as e:
        raise MjmrError(f"cannot load {reference}: {one_line(e)}") from e


def _reference(function: Callable[..., Any]) -> str:
    return f"{function.__module__}:{getattr(function, '__qualname__', '?')}"


def _asset_digest() -> str:
    from mjmr.assets import asset_folder

    digest = hashlib.sha256()
    folder: Path = asset_folder()
    for path in sorted(p for p in folder.rglob("*") if p.is_file() and p.suffix != ".md"):
        digest.update(str(path.relative_to(folder)).encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def condition_summary(condition: Mapping[str, Any], parameters: Sequence[Parameter]) -> str:
    """The values of a condition that are not at their defaults, as one writes them."""
    told = [
        f"{p.name}={format_value(condition[p.name])}"
        for p in parameters
        if condition[p.name] != p.default
    ]
    return " ".join(told) or "defaults"
