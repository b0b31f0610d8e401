"""Committed verdicts: what a study is known to give, compared with what it gives now."""

import json
from collections.abc import Sequence
from dataclasses import dataclass

from mjmr.claims import Verdict
from mjmr.errors import MjmrError
from mjmr.files import write_atomically
from mjmr.study import Study


@dataclass(frozen=True)
class Difference:
    """A verdict that is not the committed one; ``absent`` stands for none."""

    id: str
    committed: str
    now: str

    def __str__(self) -> str:
        return f"{self.id}: committed {self.committed}, now {self.now}"


def committed(study: Study, size: str) -> dict[str, str]:
    """Committed verdicts of a size by claim id.

    Raises:
        MjmrError: There are none.
    """
    found = study.committed_verdicts().get(size)
    if found is None:
        raise MjmrError(
            f"no verdicts of {study.name} are committed for size {size}; "
            f"write them with: mjmr run {study.name} --size {size} --accept"
        )
    return found


def differences(expected: dict[str, str], verdicts: Sequence[Verdict]) -> list[Difference]:
    """Where verdicts differ from those expected, either way; timing claims are left out."""
    timing = {v.claim.id for v in verdicts if v.claim.timing}
    now = {v.claim.id: v.verdict for v in verdicts}
    ids = [name for name in {**now, **expected} if name not in timing]
    pairs = [Difference(n, expected.get(n, "absent"), now.get(n, "absent")) for n in ids]
    return [pair for pair in pairs if pair.committed != pair.now]


def accept(study: Study, size: str, verdicts: Sequence[Verdict]) -> None:
    """Write these verdicts as the committed ones of a size; other sizes stay as they are.

    Raises:
        MjmrError: The study names no file for them, or it cannot be written.
    """
    if study.verdicts is None:
        raise MjmrError(f"study {study.name} declares no verdicts file to write to")
    found = study.committed_verdicts()
    found[size] = {v.claim.id: v.verdict for v in verdicts if not v.claim.timing}
    ordered = {s.name: found[s.name] for s in study.sizes if s.name in found}
    try:
        write_atomically(study.verdicts, json.dumps(ordered, indent=2) + "\n")
    except OSError as e:
        raise MjmrError(f"cannot write {study.verdicts}: {e.strerror}") from e
