"""What is claimed of every platform, and the bounds that decide it.

A bound is ours unless the data sheet gives one; all were fixed before the runs that decide them.
"""

from experiments.proving_ground import noise
from experiments.proving_ground.trial import MODULES, module
from mjmr.claims import Claim
from mjmr.robots import PLATFORMS


def claims() -> list[Claim]:
    """Every claim of the study."""
    found = [claim for platform in MODULES for claim in module(platform).claims()]
    return found + [claim for platform in PLATFORMS for claim in noise.claims(platform)]
