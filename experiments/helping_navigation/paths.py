"""Paths drawn in the office: what R1 did on the way to one target, and the trap."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from controllers.helping import GOAL, MATE, OFFER, PLAN
from experiments.helping_navigation import point
from mjmr.plot import figure

Array = NDArray[np.float64]
_COLOURS = {PLAN: "#777777", OFFER: "#2f6f9f", MATE: "#c0392b", GOAL: "#2e8b57"}
_WORDS = {
    PLAN: "R1 by its planner", OFFER: "R1 along an offer", MATE: "R1 after a mate, in trouble",
    GOAL: "R1 sees its goal",
}  # fmt: skip
_SEED = 1000  # of the paths shown: not one of those that decide claims


def drawn_paths(folder: Path) -> list[Path]:
    """Write the pictures of paths."""
    from experiments.helping_navigation import study

    tour = {"world": "world1", "planner": "visbug", "robots": 3}
    trap = {
        "scene": "trap", "world": "trap", "planner": "potential-field", "robots": 2,
        "reading": "literal", "targets": 1,
    }  # fmt: skip
    return [
        *(
            _tour(study.condition(**tour, reading=reading, targets=1), reading, folder)
            for reading in ("literal", "chain")
        ),
        _trap(study.condition(**trap), "trap-goal-sharing", folder),
        _trap(study.condition(**trap, shares_state=True, level=5), "trap-state-sharing", folder),
    ]


def _walls(axes: Any, world: str) -> None:
    for x0, y0, x1, y1 in point.office(world).walls:
        axes.plot([x0, x1], [y0, y1], color="black", linewidth=1.6)
    axes.set_aspect("equal")
    axes.grid(visible=False)


def _path(axes: Any, path: Array) -> None:
    """R1's way (t, 2) [m] coloured by mode, supporters' as thin lines; trace (t, n + 1, 2)."""
    modes = path[:, -1, 0].astype(int)
    for mode, colour in _COLOURS.items():
        on = np.flatnonzero(modes[:-1] == mode)
        if len(on):
            ways = np.stack([path[on, 0], path[on + 1, 0]], axis=1)
            x, y = np.moveaxis(np.concatenate([ways, np.full((len(on), 1, 2), np.nan)], 1), 2, 0)
            axes.plot(x.ravel(), y.ravel(), color=colour, linewidth=1.8, label=_WORDS[mode])
    for k in range(1, path.shape[1] - 1):
        axes.plot(*path[:, k].T, "--", color=f"C{3 + k}", linewidth=0.9, label=f"R{k + 1}")
        axes.plot(*path[-1, k], "o", color=f"C{3 + k}", markersize=5)


def _tour(condition: Mapping[str, Any], reading: str, folder: Path) -> Path:
    """One target across world 1, with the ghosts R2 and R3 remember at the end."""
    path = folder / f"path-{reading}.svg"
    start, goal = np.array([2.0, 9.5]), np.array([13.4, 9.4])
    crew = point.patrolling(condition, start, _SEED)
    steps, reached, trace = point.drive(condition, crew, goal[None], point.CAP, _SEED, trace=600)
    shown = trace[: min(int(steps[0]), len(trace))]
    words = "reached" if reached[0] else "given up"
    title = f"VisBug with two supporters, {reading}: {words} after {steps[0]} steps"
    with figure(path, title, "x [m]", "y [m]") as axes:
        _walls(axes, "world1")
        _path(axes, shown)
        known = crew.known
        for i in range(1, len(crew.place)):
            ghosts = known.path[i, 0, : known.ghosts[i, 0]]
            if len(ghosts):
                line = np.vstack([goal, ghosts, crew.place[i]])
                axes.plot(*line.T, ":", color=f"C{3 + i}", linewidth=0.9)
                axes.plot(
                    *ghosts.T, "o", mfc="none", color=f"C{3 + i}", label=f"ghosts of R{i + 1}"
                )
        offered = crew.offered.points[0, : crew.offered.length[0]]
        axes.plot(*offered.T, "s", mfc="none", color="#2f6f9f", label="last offer")
        axes.plot(*start, "k^", markersize=6)
        axes.plot(*goal, "k*", markersize=11)
        axes.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=4)
    return path


def _trap(condition: Mapping[str, Any], name: str, folder: Path) -> Path:
    path = folder / f"{name}.svg"
    crew, steps, reached, trace = point.trap_run(condition, _SEED)
    lengths = crew.follows[: min(int(crew.state.follows[0]), 64)]
    what = f"follows of {', '.join(map(str, lengths))} steps" if len(lengths) else "goal-sharing"
    end = f"out after {steps[0]} steps" if reached[0] else f"stuck for {steps[0]} steps"
    with figure(path, f"The trap, literal: {what}; {end}", "x [m]", "y [m]") as axes:
        _walls(axes, "trap")
        _path(axes, trace[: int(steps[0])])
        axes.plot(*point.TRAP_START, "k^", markersize=6)
        axes.plot(*crew.known.goal[0, 0], "k*", markersize=11)
        axes.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=4)
    return path
