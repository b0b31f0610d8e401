"""The claims that faults really struck hold of runs with the fault, and fail of runs without."""

import numpy as np
import pytest

from experiments.scout_workers import study
from experiments.scout_workers.field import Setting
from experiments.scout_workers.physical import PhysicalField
from experiments.scout_workers.planar import PlanarField
from experiments.scout_workers.trial import trial
from mjmr.claims import judge
from mjmr.conditions import Grid
from mjmr.table import Row, Table

CORRIDOR = {"maze": "corridor", "robots": 3, "finish": "remove", "release": 20.0}
FAULTS = {
    "ir-dead-struck-planar": {"maze": "m3", "failure": "ir-dead"},
    "scout-killed-struck-planar": {"maze": "m3", "failure": "scout-killed"},
    "worker-dead-struck-planar": CORRIDOR | {"failure": "worker-dead"},
    "bad-checksum-struck": {"maze": "m3", "failure": "bad-checksum"},
}


def claim(name):
    (found,) = [c for c in study.load_claims() if c.id == name]
    return found


def rows(given, metrics):
    (condition,) = Grid(**given).conditions(study.parameters)
    return [Row(condition, seed, "ok", m) for seed, m in metrics.items()]


def verdict(name, found):
    return judge(claim(name), Table(found, study.parameters), "standard").verdict


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_that_struck_is_told_from_one_that_did_not(name):
    given = FAULTS[name]
    faulty = {s: trial(study.condition(**given), s) for s in (1003, 1004)}
    sound = {1005: trial(study.condition(**{**given, "failure": "none"}), 1005)}
    assert verdict(name, rows(given, faulty)) == "holds"
    assert verdict(name, rows(given, faulty | sound)) == "fails"


def test_bits_read_wrong_are_seen_in_what_is_accepted():
    sound, faulty = {"maze": "m3", "bit_error": 0.0}, {"maze": "m3", "bit_error": 0.05}
    found = [{s: trial(study.condition(**g), s) for s in (1003, 1004)} for g in (sound, faulty)]
    name = "bit-errors-struck"
    assert verdict(name, rows(sound, found[0]) + rows(faulty, found[1])) == "holds"
    assert verdict(name, rows(sound, found[0]) + rows(faulty, found[0])) == "fails"


def test_the_interval_of_misled_runs_decides_by_its_upper_end():
    given = {"maze": "m3", "bit_error": 0.1}

    def of(n):
        return rows(given, {s: {"groups_undetected": int(s < 3)} for s in range(n)})

    assert verdict("bit-errors-misled", of(120)) == "holds"
    assert verdict("bit-errors-misled-interval", of(120)) == "inconclusive"
    assert verdict("bit-errors-misled-interval", of(600)) == "holds"


@pytest.mark.parametrize("kind", [PlanarField, PhysicalField])
@pytest.mark.parametrize("dead", [True, False])
def test_what_dead_detectors_hide_is_counted(kind, dead):
    """A robot turns between two blocks 0.3 m apart."""
    blocks = np.array([[0.3, 0.3, 1.1, 1.1], [1.4, 0.3, 2.2, 1.1]])
    setting = Setting(
        n=1,
        seed=1000,
        size=2.5,
        blocks=blocks,
        nest=np.array([1.25, 0.7]),
        goal=np.array([2.2, 2.2]),
        blind=np.array([dead]),
    )
    where = kind(setting)
    assert where.put_down(0)
    seen = 0
    for _ in range(8):
        seen += int(where.sense().ir.any())
        where.advance(np.array([[0.0, 1.0]]))
    hidden = where.tally().hidden[0]
    assert (hidden > 0, seen > 0) == (dead, not dead)
