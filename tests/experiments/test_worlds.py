"""Every installed study has a world for every kind of condition it runs."""

import pytest

from mjmr.registry import load_study, study_references


@pytest.mark.parametrize("name", sorted(study_references()))
def test_first_condition_of_every_grid_has_a_world(name):
    study = load_study(name)
    build = study.resolve("world")
    if build is None:
        pytest.skip("it declares no world")
    seen = {}
    for size in study.sizes:
        for grid in size.grids:
            condition = next(iter(grid.conditions(study.parameters)))
            seen[condition] = None
    for condition in seen:
        world = build(condition)
        assert [group.n for group in world.groups], condition
