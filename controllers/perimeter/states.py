"""States of the hybrid automaton; ACQUIRE is a sub-state of the paper's TRACKING (ours)."""

SEARCHING, MOVING, ACQUIRE, TRACKING = range(4)
STATES = ("SEARCHING", "MOVING", "ACQUIRE", "TRACKING")
TRANSITIONS = (
    (SEARCHING, "senses", ACQUIRE),
    (MOVING, "senses", ACQUIRE),
    (SEARCHING, "told", MOVING),
    (MOVING, "misled", SEARCHING),
    (ACQUIRE, "aligned", TRACKING),
    (TRACKING, "astray", ACQUIRE),
    (ACQUIRE, "lost", SEARCHING),
    (TRACKING, "lost", SEARCHING),
)
"""(state, cue, next state): in order, at most one a step."""
