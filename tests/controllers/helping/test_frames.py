import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from controllers.helping.frames import to_mine, turn

_angle = st.floats(-np.pi, np.pi)
_metres = st.floats(-30, 30)


def _into(frame, point):
    """A point of the world in a frame (x, y, heading)."""
    x, y, a = frame
    dx, dy = point[0] - x, point[1] - y
    return np.cos(a) * dx + np.sin(a) * dy, -np.sin(a) * dx + np.cos(a) * dy


@settings(deadline=None)  # the first call compiles
@given(
    st.tuples(_metres, _metres, _angle), st.tuples(_metres, _metres, _angle),
    st.tuples(_metres, _metres), st.tuples(_metres, _metres), st.tuples(_metres, _metres),
)  # fmt: skip
def test_a_point_told_is_where_it_is(mine, other, at, from_, goal):
    if np.hypot(at[0] - from_[0], at[1] - from_[1]) < 1e-3:
        return
    my, its = _into(mine, at), _into(other, from_)
    away = np.array(from_) - at
    seen_at = np.arctan2(away[1], away[0]) - mine[2]
    sees_me_at = np.arctan2(-away[1], -away[0]) - other[2]
    told = _into(other, goal)
    found = to_mine(*told, *its, *my, np.hypot(*away), seen_at, sees_me_at)
    np.testing.assert_allclose(found, _into(mine, goal), atol=1e-8)


def test_the_papers_angle():
    # frames aligned, the other due north: it sees me due south
    assert np.isclose(np.cos(turn(np.pi / 2, -np.pi / 2)), 1.0)
    # its frame turned by 30 degrees: my bearing of it minus its bearing of me, plus 180 degrees
    assert np.isclose(np.degrees(turn(0.0, np.pi - np.radians(30.0))), 30.0)
