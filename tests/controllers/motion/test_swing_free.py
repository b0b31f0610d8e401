"""Moves that leave a hanging load at rest."""

import numpy as np
import pytest

from controllers.motion.swing_free import swing_free
from mjmr.errors import InvalidInputError


def residual(plan, period):
    """Amplitude left of an undamped linear pendulum's swing, as a length per g [s^2 m/s^2]."""
    w, angle = 2 * np.pi / period, np.zeros(2)
    for duration, acceleration in plan.segments:
        c, s = np.cos(w * duration), np.sin(w * duration)
        rest = np.array([-acceleration, 0.0])
        angle = rest + np.array([[c, s], [-s, c]]) @ (angle - rest)
    return np.hypot(*angle)


@pytest.mark.parametrize("displacement", [4.0, -20.0, 1.5, 0.3, -0.01])
@pytest.mark.parametrize("speed", [0.1, 1.0])
@pytest.mark.parametrize("period", [0.7, 2.0, 4.9])
def test_it_gets_there_and_nothing_swings(displacement, speed, period):
    plan = swing_free(displacement, speed, period)
    assert plan.position(plan.duration) == pytest.approx(displacement, rel=1e-9)
    assert plan.velocity(plan.duration) == pytest.approx(0.0, abs=1e-12)
    top = max(abs(plan.velocity(t)) for t in np.linspace(0, plan.duration, 200))
    assert top <= speed * (1 + 1e-9)
    peak = np.abs(plan.segments[:, 1]).max()
    assert residual(plan, period) < 1e-6 * peak
    # planned for another period it would, unless the two ramps happen to cancel
    assert max(residual(plan, share * period) for share in (0.77, 0.8, 0.83)) > 0.1 * peak


def test_no_way_is_no_move():
    assert swing_free(0.0, 1.0, 2.0).duration == 0.0


@pytest.mark.parametrize("bad", [(1.0, 0.0, 2.0), (1.0, 1.0, -1.0), (np.nan, 1.0, 2.0)])
def test_bad_input_is_refused(bad):
    with pytest.raises(InvalidInputError, match="must be"):
        swing_free(*bad)
