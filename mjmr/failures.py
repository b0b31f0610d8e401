"""Replays of failed trials beside the results of a run; light, as the driver knows no MuJoCo."""

import hashlib
from pathlib import Path

from mjmr.conditions import Condition
from mjmr.files import write_atomically
from mjmr.store import Outcome


def failure_path(folder: Path, condition: Condition, seed: int) -> Path:
    """Where a run keeps the replay of a trial that failed."""
    digest = hashlib.sha256(condition.key.encode()).hexdigest()[:12]
    return folder / "failures" / f"{digest}-seed{seed}.npz"


def keep_replay(folder: Path, outcome: Outcome) -> None:
    """Write the replay an outcome brings, in place of any from before.

    Raises:
        OSError: The folder cannot be written to.
    """
    path = failure_path(folder, outcome.condition, outcome.seed)
    if outcome.replay:
        path.parent.mkdir(exist_ok=True)
        write_atomically(path, outcome.replay)
    else:
        path.unlink(missing_ok=True)
