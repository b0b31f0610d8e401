"""Consensus control: agreement over graphs that change, formations, leaders and followers."""

from controllers.consensus.average import AverageConsensus, RatioConsensus, of_this_round
from controllers.consensus.canonical import CanonicalModel, delta, overlap_coefficient, spread
from controllers.consensus.gains import (
    check_gains,
    equal_gains,
    graph,
    metropolis_gains,
    neighbour_gains,
)
from controllers.consensus.hand import (
    command_of_velocity,
    command_rates,
    hand_position,
    hand_velocity,
)
from controllers.consensus.hand_team import HandTeam, Scan
from controllers.consensus.lag import harmonic_error, ramp_lag
from controllers.consensus.leader_follower import SeparationBearing
from controllers.consensus.relative import acceleration, offset_relative
from controllers.consensus.rules import (
    EqualGains,
    MetropolisGains,
    NeighbourGains,
    RelativeForm,
)
from controllers.consensus.structure import (
    Condensation,
    StructureReport,
    check_structure,
    condense,
    reducible,
    rooted,
)

__all__ = [
    "AverageConsensus",
    "CanonicalModel",
    "Condensation",
    "EqualGains",
    "HandTeam",
    "MetropolisGains",
    "NeighbourGains",
    "RatioConsensus",
    "RelativeForm",
    "Scan",
    "SeparationBearing",
    "StructureReport",
    "acceleration",
    "check_gains",
    "check_structure",
    "command_of_velocity",
    "command_rates",
    "condense",
    "delta",
    "equal_gains",
    "graph",
    "hand_position",
    "hand_velocity",
    "harmonic_error",
    "metropolis_gains",
    "neighbour_gains",
    "of_this_round",
    "offset_relative",
    "overlap_coefficient",
    "ramp_lag",
    "reducible",
    "rooted",
    "spread",
]
