"""The worker's side of a cluster: is it fit, and what does a trial give."""

import contextlib
import pickle
from collections.abc import Mapping
from typing import Any

from mjmr.errors import one_line
from mjmr.executor import compute
from mjmr.provenance import versions


def answer(
    found: Mapping[str, str], size: str, digest: str, job: bytes, trial: bytes | None
) -> tuple[str, Any]:
    """What a worker does when asked: check that it is fit and, given a trial, compute it.

    Args:
        found: Versions the driver has.
        size: The study's size.
        digest: What the study's digest must be.
        job: Pickled :class:`mjmr.parts.Job`.
        trial: Pickled condition and seed; None only checks.

    Returns:
        ``("unfit", why)``, ``("fit", None)`` or ``("outcome", pickled outcome)``.
    """
    try:
        why = _unfit(found, size, digest, job)
    except Exception as e:
        why = f"cannot load the study ({one_line(e)})"
    if why:
        return "unfit", why
    if trial is None:
        return "fit", None
    return "outcome", pickle.dumps(compute(pickle.loads(job), *pickle.loads(trial)))


def _unfit(found: Mapping[str, str], size: str, digest: str, job: bytes) -> str:
    from distributed import get_worker

    from mjmr.registry import load_study

    with contextlib.suppress(ValueError, AttributeError):  # asked outside a task
        threads = get_worker().state.nthreads
        if threads != 1:
            return wrong_threads(threads)
    mine = versions()
    others = [
        f"{n} {mine.get(n)} where {v} is wanted" for n, v in found.items() if v != mine.get(n)
    ]
    if others:
        return f"has {', '.join(others)}"
    wanted = pickle.loads(job)
    theirs = load_study(wanted.study).choose(wanted.parts).digest(size)
    if theirs != digest:
        return (
            "has the same versions but another source of mjmr or of the study "
            f"(digest {theirs[:12]} where {digest[:12]} is wanted); install the same and restart it"
        )
    return ""


def wrong_threads(count: int) -> str:
    """Why a worker with this many threads is unfit."""
    return f"has {count} threads where trials need one each: start workers with --nthreads 1"
