"""Carts: boxes that go to and fro by themselves."""

import numpy as np
import pytest

from mjmr.cart import Cart
from mjmr.errors import InvalidInputError
from mjmr.metrics import ContactMeter, OverlapMeter
from mjmr.sensors.cart_report import CartReport
from tests.mjmr.worlds import BOTH, soccer

WAY = {"length": 0.5, "width": 0.3, "travel": 1.2, "speed": 0.3}


def test_its_way_is_continuous_bounded_and_comes_back():
    cart = Cart(x=0, y=0, acceleration=0.5, start=0.3, **WAY)
    t = np.linspace(0.0, 30.0, 30001)
    s, v = np.array([cart.along(x) for x in t]).T
    assert abs(s).max() == pytest.approx(0.6, abs=1e-6)
    assert abs(v).max() == pytest.approx(0.3)
    np.testing.assert_allclose(np.gradient(s, t)[1:-1], v[1:-1], atol=1e-3)
    assert abs(np.gradient(v, t)[1:-1]).max() <= 0.5 + 1e-6
    period = 2 * (1.2 / 0.3 + 0.3 / 0.5)
    np.testing.assert_allclose(cart.along(1.234), cart.along(1.234 + period), atol=1e-9)


def test_a_short_way_never_reaches_top_speed():
    cart = Cart(x=0, y=0, length=0.1, width=0.1, travel=0.1, speed=5.0, acceleration=0.4)
    speeds = [abs(cart.along(t)[1]) for t in np.linspace(0, 5, 5001)]
    assert max(speeds) == pytest.approx(np.sqrt(0.1 * 0.4), rel=1e-3)


@pytest.mark.parametrize("kind", BOTH)
def test_simulations_move_it_along_its_way(kind):
    world, _ = soccer([[-2.0, -1.5, 0.0]])
    cart = world.add_cart(0.5, 0.2, yaw=0.6, start=0.1, **WAY)
    simulation = kind(world, seed=0)
    errors = []

    def compare():
        want = cart.box(cart.along(simulation.time)[0])
        errors.append(np.abs(simulation.truth.carts()[0] - want).max())

    simulation.observe(compare)
    for _ in simulation.ticks(10.0):
        pass
    assert len(errors) == 601
    assert max(errors) < (0.004 if kind is BOTH[0] else 1e-12)


def test_it_pushes_a_robot_and_is_counted():
    world, robots = soccer([[0.5, 0.0, 0.0]])
    world.add_cart(0.0, 0.0, length=0.4, width=0.4, travel=0.8, speed=0.3)
    simulation = BOTH[0](world)
    meter = ContactMeter(simulation)
    for _ in simulation.ticks(4.0):
        robots.drive(np.zeros((1, 3)))
    assert meter.obstacles > 0.5
    assert meter.robots == 0.0


def test_overlap_with_a_cart_is_taken_where_the_cart_is():
    """It passes through a robot at rest: depth times time is known."""
    world, _ = soccer([[0.0, 0.0, 0.0]])
    world.add_cart(0.0, 0.0, length=0.2, width=2.0, travel=2.0, speed=0.5, acceleration=50.0)
    simulation = BOTH[1](world)
    meter = OverlapMeter(simulation)
    for _ in simulation.ticks(3.9):
        pass
    # the depth rises by 0.5 m/s from -0.19 m to 0.19 m at the middle and falls again
    assert meter.obstacles == pytest.approx(0.19**2 / 0.5, rel=2e-3)


def test_reports_are_noisy_and_late():
    world, _ = soccer([[-2.0, -1.5, 0.0]])
    cart = world.add_cart(0.0, 0.0, **WAY)
    report = world.mount(CartReport(rate=60.0, latency=1 / 30, position_noise=0.01))
    simulation = BOTH[1](world, seed=3)
    errors, first = [], None
    for t in simulation.ticks(5.0):
        box = report.read()[0]
        first = box if first is None else first
        if not np.isnan(box[0]):
            errors.append(box[:2] - cart.box(cart.along(t - 1 / 30)[0])[:2])
    assert np.isnan(first).all()
    assert np.std(errors) == pytest.approx(0.01, rel=0.1)


@pytest.mark.parametrize(
    "wrong", [{"travel": 0.0}, {"speed": -1.0}, {"length": np.nan}, {"start": 1.5}]
)
def test_what_cannot_be_is_refused(wrong):
    with pytest.raises(InvalidInputError, match=next(iter(wrong))):
        Cart(x=0, y=0, **{**WAY, **wrong})
