"""Rows of flags over time, and a team's graph drawn with them."""

import numpy as np
import pytest

from mjmr.errors import InvalidInputError
from mjmr.plot import edge_rows, figure, flag_rows


def spans(axes):
    """Drawn bars of each row: (start, end)."""
    found = []
    for bars in axes.collections:
        boxes = [path.get_extents() for path in bars.get_paths()]
        found.append([(round(b.x0, 6), round(b.x1, 6)) for b in boxes])
    return found


def test_bars_are_where_flags_are_set(tmp_path):
    flags = np.array([[1, 0], [1, 0], [0, 1], [1, 1]])
    with figure(tmp_path / "rows.svg", "t", "x", "") as axes:
        flag_rows(axes, [0.0, 1.0, 3.0, 4.0], flags, ["a", "b"])
        assert spans(axes) == [[(0.0, 3.0), (4.0, 5.0)], [(3.0, 5.0)]]
        assert [t.get_text() for t in axes.get_yticklabels()] == ["a", "b"]
    assert (tmp_path / "rows.svg").stat().st_size > 1000


def test_a_graph_has_a_row_for_every_pair_that_ever_hears(tmp_path):
    graphs = np.tile(np.eye(3, dtype=bool), (3, 1, 1))
    graphs[1:, 0, 2] = True
    graphs[0, 2, 1] = True
    with figure(tmp_path / "edges.svg", "t", "x", "") as axes:
        edge_rows(axes, [0.0, 1.0, 2.0], graphs, ["A", "B", "C"])
        assert [t.get_text() for t in axes.get_yticklabels()] == ["A hears C", "C hears B"]
        assert spans(axes) == [[(1.0, 3.0)], [(0.0, 1.0)]]


def test_shapes_that_do_not_fit_are_refused():
    with pytest.raises(InvalidInputError, match=r"flags have shape \(k, 2\)"):
        flag_rows(None, [0.0, 1.0], np.ones((2, 3)), ["a", "b"])
    with pytest.raises(InvalidInputError, match=r"graphs have shape \(k, 2, 2\)"):
        edge_rows(None, [0.0, 1.0], np.ones((2, 3, 3)), ["a", "b"])
