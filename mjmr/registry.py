"""Finding studies by name, through the entry-point group ``mjmr.studies``.

The environment variable ``MJMR_STUDIES`` adds more, as ``name=package.module:attribute`` separated
by spaces: for development and tests.
"""

import os
from importlib.metadata import entry_points

from mjmr.errors import InvalidInputError, MjmrError, UnknownNameError
from mjmr.study import Study, resolve

GROUP = "mjmr.studies"


def study_references() -> dict[str, str]:
    """Every study's name and dotted reference, sorted by name; imports none of them.

    Raises:
        MjmrError: A name is taken by two different studies.
        InvalidInputError: ``MJMR_STUDIES`` is not of the form described above.
    """
    found: dict[str, str] = {}
    named = [(point.name, point.value.replace(" ", "")) for point in entry_points(group=GROUP)]
    for text in os.environ.get("MJMR_STUDIES", "").split():
        name, equals, reference = text.partition("=")
        if not (name and equals and ":" in reference):
            raise InvalidInputError(
                f"MJMR_STUDIES holds {text!r}; expected name=package.module:attribute"
            )
        named.append((name, reference))
    for name, reference in named:
        # The same distribution may be on the path twice; that is no conflict.
        if found.setdefault(name, reference) != reference:
            raise MjmrError(
                f"two studies are called {name!r}: {found[name]} and {reference}; remove one"
            )
    return dict(sorted(found.items()))


def load_study(name: str) -> Study:
    """The study called ``name``, or the one a dotted reference ``module:attribute`` names.

    Raises:
        UnknownNameError: No such study; lists those there are, nearest first.
        MjmrError: It cannot be imported, or is not a study of this name.
    """
    references = study_references()
    if name in references:
        reference = references[name]
    elif ":" in name:
        reference = name
    else:
        raise UnknownNameError("study", name, references)
    study = resolve(reference)
    if not isinstance(study, Study):
        raise MjmrError(f"{reference} is not a Study but a {type(study).__name__}")
    if name in references and study.name != name:
        raise MjmrError(f"{reference} is registered as {name!r} but calls itself {study.name!r}")
    return study
