"""An office for tests, as arrays: world 1 of the study and a room with a dead end."""

from functools import cache
from pathlib import Path

import numpy as np

from controllers.helping import Walls
from mjmr.office import load_office

FOLDER = Path(__file__).parents[3] / "experiments" / "helping_navigation" / "offices"
RADIUS, KEPT = 0.22, 0.235


@cache
def place(name="world1"):
    return load_office(FOLDER / f"{name}.json", KEPT)


@cache
def walls(name="world1"):
    office = place(name)
    path, links = office.edges(KEPT + 0.001)
    after, before = np.ascontiguousarray(links.T)
    sight, kept, motion = (office.edges(c)[0] for c in (RADIUS, RADIUS - 0.03, KEPT))
    return Walls(sight, kept, motion, path, after, before)


def inside(office, rng, count):
    """Points (count, 2) in the free space."""
    import shapely

    free = office.free_space(KEPT)
    found = []
    while len(found) < count:
        point = rng.uniform([0, 0], office.size)
        if free.contains(shapely.Point(point)):
            found.append(point)
    return np.array(found)
