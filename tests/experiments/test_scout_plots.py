"""The plots of spreads are written from the trials that are about them, and only then."""

from experiments.scout_workers import study
from experiments.scout_workers.plots import plots
from experiments.scout_workers.plots_spread import spreads
from mjmr.conditions import Grid
from mjmr.table import Row, Table


def table(*grids):
    rows = []
    for given, metrics in grids:
        for condition in Grid(**given).conditions(study.parameters):
            rows += [Row(condition, seed, "ok", metrics) for seed in range(2)]
    return Table(rows, study.parameters)


PAIR = {"scout_error_m": 0.1, "latency_s": 0.5, "scout_s": 50.0, "worker_s": 10.0}
PHASE = {"period_ms": 150.0, "period_least_ms": 35.0, "period_most_ms": 800.0}
PAIRS = ({"maze": ("m1", "m3"), "bit_error": 0.0}, PAIR)
SILENT = ({"maze": "m3", "bit_error": 0.1}, PAIR | {"latency_s": None})
PHASES = ({"mode": "radio", "experiment": "phase", "jitter_ms": (0.0, 0.5)}, PHASE)


def test_each_spread_is_drawn_from_its_trials(tmp_path):
    written = plots(table(PAIRS, SILENT, PHASES), tmp_path)
    assert {p.name for p in written} == {
        "tracks.svg", "times.svg", "scout_error.svg", "latency.svg", "jitter.svg"
    }  # fmt: skip
    drawn = (tmp_path / "latency.svg").read_text()
    assert "0 % of bits wrong" in drawn
    assert "10 % of bits wrong" not in drawn, "nobody ever heard anything"


def test_without_trials_nothing_is_drawn(tmp_path):
    one = table(({"mode": "radio", "experiment": "phase"}, PHASE))
    assert spreads(one, one.where(experiment="maze"), tmp_path) == []
