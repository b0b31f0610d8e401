"""What is claimed of scouts and workers, and what decides it.

The paper's times are lost (its figure 3.8 is a drawing); its words stand as printed, what begins
with "ours" or "not in the paper" is not its, and every bound is ours.
"""

from experiments.scout_workers.claims_beyond import beyond
from experiments.scout_workers.claims_group import group
from experiments.scout_workers.claims_maze import mazes
from experiments.scout_workers.claims_radio import radio
from experiments.scout_workers.claims_struck import struck
from mjmr.claims import Claim


def claims() -> list[Claim]:
    """Every claim of the study."""
    return [*mazes(), *radio(), *group(), *struck(), *beyond()]
