"""Holding a swapped part to what its role demands: before a run, and at every call.

A class that cannot take the role is refused before any trial. What its methods return is checked
each time, so that a mistake is told as the part's, with robot and tick, and not found later as odd
metrics.
"""

import inspect
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError, MissingGLError, PartError, one_line
from mjmr.parts import Method, Part, shape_text


def check(part: Part, reference: str, loaded: Any) -> None:
    """Refuse what cannot take a role; calls nothing of it.

    Args:
        part: The role.
        reference: How the class was named, for messages.
        loaded: The class, or a function that builds one.

    Raises:
        PartError: Not callable, or a constructor or method that is missing or takes other
            arguments; says what the role demands.
    """

    def refuse(what: str) -> PartError:
        needs = f"; a {part.role} has {part.interface}" if part.interface else ""
        return PartError(f"{reference} cannot be the {part.role}: {what}{needs}")

    if not callable(loaded):
        raise refuse(f"it is no class but a {type(loaded).__name__}")
    if part.constructor is not None and not _accepts(loaded, part.constructor):
        raise refuse(f"its constructor takes {_signature(loaded)}")
    for method in part.methods if isinstance(loaded, type) else ():
        found = getattr(loaded, method.name, None)
        if found is None and method.optional:
            continue
        if found is None:
            raise refuse(f"it has no method {method.name}")
        if not callable(found):
            raise refuse(f"its {method.name} is no method but a {type(found).__name__}")
        plain = isinstance(inspect.getattr_static(loaded, method.name), staticmethod | classmethod)
        if not _accepts(found, method.arguments if plain else ("self", *method.arguments)):
            raise refuse(f"its method {method.name} takes {_signature(found)}")


def _accepts(function: Any, arguments: Sequence[str]) -> bool:
    try:
        inspect.signature(function).bind(*arguments)
    except TypeError:
        return False
    except ValueError:  # built in: no signature to look at
        return True
    return True


def _signature(function: Any) -> str:
    found = inspect.signature(function)
    bare = [p.replace(annotation=p.empty) for p in found.parameters.values()]
    return str(found.replace(parameters=bare, return_annotation=found.empty))


class Guard:
    """An instance of a swapped part whose methods are checked; other attributes are its own.

    Arrays are copied on the way in and out, so that a part that keeps or changes them does no harm.
    """

    def __init__(
        self,
        part: Part,
        reference: str,
        loaded: Callable[..., Any],
        arguments: Sequence[Any],
        when: Callable[[], str],
    ):
        """Build the instance.

        Args:
            part: The role.
            reference: How the class was named, for messages.
            loaded: The class.
            arguments: Of its constructor.
            when: Says the present tick; empty if it is not known, then calls are counted.

        Raises:
            PartError: The constructor raised, or built what lacks a method.
        """
        self._told = f"{part.role} {reference}"
        self._when = when
        arguments = [_copy(a) for a in arguments]
        sizes = dict(zip(part.constructor or (), arguments, strict=False))
        self._part = self._call("its constructor", str, loaded, arguments)
        for method in part.methods:
            if callable(getattr(self._part, method.name, None)):
                # An attribute of the instance: found without __getattr__.
                setattr(self, method.name, self._checked(method, sizes))
            elif not method.optional:
                raise PartError(f"{self._told} built an object without a method {method}")

    def __getattr__(self, name: str) -> Any:
        if name == "_part":  # not built yet
            raise AttributeError(name)
        return getattr(self._part, name)

    def _checked(self, method: Method, sizes: dict[str, Any]) -> Callable[..., Any]:
        wanted = method.returns
        shape = tuple(int(sizes[s]) if isinstance(s, str) else s for s in wanted or ())
        robots = bool(wanted) and isinstance(wanted[0], str)
        function, calls = getattr(self._part, method.name), -1
        from mjmr.study import resolve

        demand: Callable[..., Any] | None = resolve(method.check)

        def when() -> str:
            return self._when() or f"at call {calls}"

        def call(*arguments: Any) -> Any:
            nonlocal calls
            calls += 1
            returned = self._call(method.name, when, function, [_copy(a) for a in arguments])
            if wanted is None:
                return returned
            array, wrong = _floats(returned, shape, robots)
            if wrong:
                unit = f" [{method.unit}]" if method.unit else ""
                raise PartError(
                    f"{self._told} returned {wrong} {when()}; {method.name} must "
                    f"return finite floats of shape {shape_text(shape)}{unit}"
                )
            if demand is not None:
                try:
                    demand(array, *arguments)
                except InvalidInputError as e:
                    raise PartError(f"what {self._told} returned {when()} cannot be: {e}") from e
            return array

        return call

    def _call(
        self, what: str, when: Callable[[], str], function: Callable[..., Any], arguments: Any
    ) -> Any:
        try:
            return function(*arguments)
        except MissingGLError:
            raise
        except (Exception, SystemExit) as e:  # a part that exits shall not end its worker
            told = f"{self._told} raised in {what} {when()}".rstrip()
            raise PartError(f"{told}: {one_line(e)}") from e


def _copy(value: Any) -> Any:
    return value.copy() if isinstance(value, np.ndarray) else value


def _floats(
    value: Any, shape: tuple[int, ...], robots: bool
) -> tuple[NDArray[np.float64] | None, str]:
    """A returned value as a new array, or what is wrong with it in words."""
    try:
        array = np.asarray(value)
    except ValueError:
        return None, "rows of unequal length"
    if array.dtype.kind not in "fiub":
        return None, "nothing" if value is None else f"a {type(value).__name__}, no numbers"
    if array.shape != shape:
        return None, f"shape {shape_text(array.shape)}"
    finite = np.isfinite(array)
    if finite.all():
        return array.astype(np.float64), ""  # a copy, whatever it was
    odd = "NaN" if np.isnan(array).any() else "infinity"
    if not robots:
        return None, odd
    rows = np.flatnonzero(~finite.reshape(shape[0], -1).all(axis=1))
    listed = ", ".join(map(str, rows))
    return None, f"{odd} for robot{'s' if len(rows) > 1 else ''} {listed}"
