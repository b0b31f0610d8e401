"""Keyframes of the Sony AIBO ERS-7: getting up and kicks.

Standing up and rolling off the back are those of a reference run; rolling off a side and the kicks
are made from it by evolution for the model in assets/aibo_ers7, whose README says how, and how
well they do. Tables are in degrees.
"""

import numpy as np

from controllers.legged.ers7_gaits import ERS7_HOME
from controllers.legged.get_up import GetUpPlan
from controllers.legged.keyframes import Keyframes
from controllers.legged.kicks import Kick

# joints that mirrored robots exchange: left legs with right ones, ears; pan and tail_pan turn over
_EXCHANGED = [3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8, 12, 13, 14, 15, 16, 17, 19, 18]
_TURNED = np.where(np.isin(np.arange(20), [13, 17]), -1.0, 1.0)
_Three = tuple[float, float, float]
_Legs = tuple[_Three, _Three, _Three, _Three]


def _sequence(*keys: tuple[float, _Legs, _Three], stepped: bool = False) -> Keyframes:
    """Keyframes of (seconds, (fl, fr, hl, hr), (tilt1, pan, tilt2)); other joints at home."""
    angles = np.tile(ERS7_HOME, (len(keys), 1))
    angles[:, :12] = np.radians([np.ravel(legs) for _, legs, _ in keys])
    angles[:, 12:15] = np.radians([head for _, _, head in keys])
    return Keyframes(angles=angles, seconds=np.array([key[0] for key in keys]), stepped=stepped)


def _pairs(fore: _Three, hind: _Three) -> _Legs:
    return fore, fore, hind, hind


def mirrored(keyframes: Keyframes) -> Keyframes:
    """The same with left and right exchanged."""
    return keyframes.mirrored(_EXCHANGED, _TURNED)


# fmt: off
# with the trunk upright, however the legs lie: out, tuck in, stand
ERS7_STAND_UP = _sequence(
    (0.50, _pairs((0, 85, 0), (0, 85, 0)), (-20, 0, 20)),
    (0.50, _pairs((20, 60, 100), (20, 60, 100)), (-20, 0, 20)),
    (0.50, _pairs((-30, 5, 110), (-40, 5, 115)), (-20, 0, 20)),
    (0.50, _pairs((-10, 8, 60), (-25, 8, 70)), (-20, 0, 20)),
    stepped=True,
)
# from the left side to the belly: the lower legs push behind the back
ERS7_OFF_LEFT = _sequence(
    (0.45, ((98, -10, 40), (9, -7, -21), (111, 3, 116), (-19, -10, -23)), (-10, -45, 20)),
    (0.17, ((108, -10, 92), (-50, 22, 36), (112, -10, 70), (-34, 7, -13)), (-54, -69, 20)),
    (0.30, ((-13, 29, -17), (32, 88, 41), (-6, 24, 52), (-9, 75, 50)), (-6, 28, 20)),
    stepped=True,
)
# from the back to the belly, over the right side
ERS7_OFF_BACK = _sequence(
    (0.56, ((6, -10, -25), (130, -10, -25), (6, -10, -25), (115, -10, -25)), (-17, 70, 20)),
    (0.35, ((130, -10, 87), (130, -10, 53), (115, -10, 87), (115, -10, 53)), (-17, -64, 20)),
    (0.42, ((25, 78, -10), (26, 88, 106), (25, 78, -10), (26, 88, 106)), (-17, -46, 20)),
    stepped=True,
)
# crouch behind the ball, feet in to a V that holds it, then forelegs and hind legs push
_FORWARD = _sequence(
    (0.42, _pairs((-25, 23, 21), (-48, 8, 119)), (-9, 0, 20)),
    (0.23, _pairs((-25, -1, 21), (-48, 8, 119)), (-9, 0, 20)),
    (0.10, _pairs((-25, -1, 21), (-48, 8, 119)), (-9, 0, 20)),
    (0.16, _pairs((116, -10, -14), (47, 5, 94)), (-3, 0, 20)),
    (0.40, _pairs((116, -10, -14), (47, 5, 94)), (-3, 0, 20)),
    (0.50, _pairs((-15, 7, 63), (-30, 8, 81)), (-20, 0, 20)),
)
# turn the head away, lower it beside the ball, then sweep; it comes up before it turns back
_HEAD_LEFT = _sequence(
    (0.35, ((-66, 33, 71), (-16, -10, 100), (-9, -10, 59), (-71, 33, 87)), (0, -57, 11)),
    (0.40, ((-66, 33, 71), (-16, -10, 100), (-9, -10, 59), (-71, 33, 87)), (-68, -57, 11)),
    (0.10, ((-66, 33, 71), (-16, -10, 100), (-9, -10, 59), (-71, 33, 87)), (-68, -57, 11)),
    (0.03, ((17, 7, 122), (-87, 51, 122), (-68, 40, 50), (-8, -10, 19)), (-68, -57, 11)),
    (0.18, ((17, 7, 122), (-87, 51, 122), (-68, 40, 50), (-8, -10, 19)), (-63, 64, 40)),
    (0.30, ((17, 7, 122), (-87, 51, 122), (-68, 40, 50), (-8, -10, 19)), (-63, 64, 40)),
    (0.15, ((17, 7, 122), (-87, 51, 122), (-68, 40, 50), (-8, -10, 19)), (0, 64, 40)),
    (0.50, ((-15, 7, 63), (-15, 7, 63), (-30, 8, 81), (-30, 8, 81)), (-20, 0, 20)),
)
# fmt: on

ERS7_GET_UP = GetUpPlan(
    stand=ERS7_STAND_UP,
    off_left=ERS7_OFF_LEFT,
    off_right=mirrored(ERS7_OFF_LEFT),
    off_back_left=mirrored(ERS7_OFF_BACK),
    off_back_right=ERS7_OFF_BACK,
)
# by their codes in controllers/legged/motion.py
ERS7_KICKS = {
    1: Kick(keyframes=_FORWARD, ball=(0.124, 0.0), direction=0.0, distance=2.0),
    2: Kick(keyframes=_HEAD_LEFT, ball=(0.201, 0.057), direction=np.pi / 2, distance=1.6),
    3: Kick(
        keyframes=mirrored(_HEAD_LEFT),
        ball=(0.201, -0.057),
        direction=-np.pi / 2,
        distance=1.6,
    ),
}
