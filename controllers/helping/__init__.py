"""Teammates that lend their eyes (Sgorbissa and Arkin): goal-sharing, state-sharing, planners."""
