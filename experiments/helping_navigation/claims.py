"""What is claimed, how it is measured, and the bounds that decide it.

Bounds marked ``ours`` come from a reference run on other tasks and were fixed before the runs that
decide them. Steps are a mean over the targets a task reached; targets given up are counted apart.
"""

from experiments.helping_navigation.claims_beyond import beyond
from experiments.helping_navigation.claims_noise import noise
from experiments.helping_navigation.claims_physical import physical
from experiments.helping_navigation.claims_scenes import scenes
from experiments.helping_navigation.claims_tables import tables
from mjmr.claims import Claim


def claims() -> list[Claim]:
    """Every claim of the study."""
    return [*tables(), *noise(), *scenes(), *beyond(), *physical()]
