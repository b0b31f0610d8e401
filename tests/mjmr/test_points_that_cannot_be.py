"""Points of sensors that are no numbers, of another length or not finite are told in a sentence."""

import pytest

from mjmr.errors import InvalidInputError
from mjmr.sensors.beacon import Beacon
from mjmr.sensors.cone_sight import ConeSight
from mjmr.sensors.imu import IMU
from mjmr.sensors.spot import Spot

BAD = ["here", [1.0, [2.0]], [1.0, 2.0, 3.0, 4.0], [1.0, float("nan"), 0.0], None]


@pytest.mark.parametrize("point", BAD)
def test_points_that_cannot_be(point):
    with pytest.raises(InvalidInputError, match="a beacon's position is two finite numbers"):
        Beacon(position=point, rate=10.0)
    with pytest.raises(InvalidInputError, match=r"mark is a point \(3,\)"):
        ConeSight(cone=1.0, range=3.0, eye=(0, 0, 0), mark=point, rate=10.0)
    with pytest.raises(InvalidInputError, match="position has three finite numbers"):
        IMU(position=point, rate=100.0)
    with pytest.raises(InvalidInputError, match="two points of three numbers"):
        Spot(position=point, target=(0, 0, 0), kind="robot", rate=10.0)
