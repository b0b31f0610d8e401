"""From what is written after ``--with`` to classes.

A file is read once, by the driver; its text travels with the choice, and every process builds the
module from that text. So all workers, on whatever machine, run what the driver read, even if the
file has changed or gone since.
"""

import functools
import hashlib
import importlib.machinery
import importlib.util
import linecache
import os
import sys
import tokenize
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType
from typing import Any

from mjmr.errors import InvalidInputError, PartError, nearest_first, one_line
from mjmr.parts import PartChoice

_FORM = "ROLE=package.module:Class or ROLE=path/to/file.py:Class"


def parse_choices(texts: Iterable[str]) -> tuple[PartChoice, ...]:
    """Choices from texts ``ROLE=REFERENCE``; a file's text is read here.

    Args:
        texts: REFERENCE is ``package.module:Class`` or ``path/to/file.py:Class``, the path
            relative to the current folder, absolute, or from ``~``.

    Raises:
        InvalidInputError: Not of this form, or a role twice.
        PartError: A file that cannot be read.
    """
    found: dict[str, PartChoice] = {}
    for text in texts:
        role, _, reference = text.partition("=")
        where, _, name = reference.rpartition(":")
        if not (role and where and name.isidentifier()):
            raise InvalidInputError(f"expected {_FORM}, not {text!r}")
        if role in found:
            raise InvalidInputError(f"{role} is given twice; one class can take a role")
        is_file = where.endswith(".py") or os.sep in where
        source = _read(where, reference) if is_file else None
        found[role] = PartChoice(role, reference, source)
    return tuple(found.values())


def _read(path: str, reference: str) -> str:
    try:
        with tokenize.open(Path(path).expanduser()) as file:  # heeds the file's declared coding
            return file.read()
    except OSError as e:
        raise PartError(f"cannot read the file of {reference}: {e.strerror}") from e
    except (RuntimeError, SyntaxError, UnicodeError) as e:  # no home, unknown or wrong coding
        raise PartError(f"cannot read the file of {reference}: {one_line(e)}") from e


@functools.cache
def load(choice: PartChoice) -> Any:
    """What a choice refers to.

    Raises:
        PartError: The module cannot be built or imported, or has no such name.
    """
    where, _, name = choice.reference.rpartition(":")
    try:
        if choice.source is None:
            module = importlib.import_module(where)
        else:
            module = _build(choice.source, where)
    except (Exception, SystemExit) as e:
        raise PartError(f"cannot load {choice.reference}: {one_line(e)}{_advice(e, choice)}") from e
    if not hasattr(module, name):
        package = where.partition(".")[0]
        classes = [
            n
            for n, v in vars(module).items()
            # its own, or what a package gathers of its modules
            if isinstance(v, type) and v.__module__.partition(".")[0] in (module.__name__, package)
        ]
        listed = ", ".join(nearest_first(name, classes)) or "none"
        raise PartError(f"{where} has no {name}; its classes: {listed}")
    return getattr(module, name)


def _advice(e: BaseException, choice: PartChoice) -> str:
    if not isinstance(e, ModuleNotFoundError):
        return ""
    if choice.source is None:
        return "; it is looked for where Python looks: install it or set PYTHONPATH"
    return "; a file travels alone, so what it imports must be installed or on PYTHONPATH"


def _build(source: str, path: str) -> ModuleType:
    """A module from its text, under a name that says which text it is.

    It has no ``__file__``: on another machine there is none. Tracebacks show lines all the same.
    """
    digest = hashlib.sha256(f"{path}\n{source}".encode()).hexdigest()[:12]
    name = f"mjmr_part_{digest}"
    spec = importlib.machinery.ModuleSpec(name, None, origin=path)
    module = importlib.util.module_from_spec(spec)
    # Without a time of change the cache does not look for a newer text on disk.
    linecache.cache[path] = len(source), None, source.splitlines(keepends=True), path
    sys.modules[name] = module  # dataclasses and pickle look here
    try:
        exec(compile(source, path, "exec", dont_inherit=True), module.__dict__)
    except BaseException:
        del sys.modules[name]
        raise
    return module


def choice_digest(choice: PartChoice) -> list[str]:
    """What makes results of a choice what they are: its reference, and a digest of its source.

    The source of a file is its text, wherever it lies; of a dotted reference, the packages that
    the reference and the class it leads to are in.
    """
    where, _, name = choice.reference.rpartition(":")
    if choice.source is not None:
        return [choice.role, name, hashlib.sha256(choice.source.encode()).hexdigest()]
    modules = {where, getattr(load(choice), "__module__", where)}
    return [choice.role, choice.reference, *(_module_digest(m) for m in sorted(modules))]


def _module_digest(module: str) -> str:
    from mjmr.provenance import source_digest

    spec = importlib.util.find_spec(module)
    package = module if spec and spec.submodule_search_locations else module.rpartition(".")[0]
    if package or spec is None or spec.origin is None:
        return source_digest(package or module)
    # A module outside of any package: its file alone, not the folder it happens to lie in.
    return hashlib.sha256(Path(spec.origin).read_bytes()).hexdigest()
