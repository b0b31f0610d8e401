"""Keyframes of the Sony AIBO ERS-7: getting up and kicks.

Made for the model in assets/aibo_ers7 by evolution, from the starting values of a reference run;
its README says how, and how well they do. Tables are in degrees.
"""

import numpy as np

from controllers.legged.get_up import GetUpPlan
from controllers.legged.keyframes import Keyframes
from controllers.legged.kicks import Kick

ERS7_HOME = np.radians(
    [-15, 7, 63, -15, 7, 63, -30, 8, 81, -30, 8, 81] + [-20, 0, 20, -5, 30, 0, 2, 2]
)
# joints that mirrored robots exchange: left legs with right ones, ears; pan and tail_pan turn over
_EXCHANGED = [3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8, 12, 13, 14, 15, 16, 17, 19, 18]
_TURNED = np.where(np.isin(np.arange(20), [13, 17]), -1.0, 1.0)
_Three = tuple[float, float, float]


def _sequence(
    *keys: tuple[float, _Three, _Three, _Three, _Three, _Three], stepped: bool = False
) -> Keyframes:
    """Keyframes of (seconds, fl, fr, hl, hr, (tilt1, pan, tilt2)); other joints at home."""
    angles = np.tile(ERS7_HOME, (len(keys), 1))
    angles[:, :15] = np.radians([np.concatenate(key[1:]) for key in keys])
    seconds = np.array([key[0] for key in keys])
    return Keyframes(angles=angles, seconds=seconds, stepped=stepped)


def mirrored(keyframes: Keyframes) -> Keyframes:
    """The same with left and right exchanged."""
    return keyframes.mirrored(_EXCHANGED, _TURNED)


# from the belly, or with the trunk upright however the legs lie: out, tuck in, stand
ERS7_STAND_UP = _sequence(
    (0.500, (0, 85, 0), (0, 85, 0), (0, 85, 0), (0, 85, 0), (-20, 0, 20)),
    (0.500, (20, 60, 100), (20, 60, 100), (20, 60, 100), (20, 60, 100), (-20, 0, 20)),
    (0.500, (-30, 5, 110), (-30, 5, 110), (-40, 5, 115), (-40, 5, 115), (-20, 0, 20)),
    (0.500, (-10, 8, 60), (-10, 8, 60), (-25, 8, 70), (-25, 8, 70), (-20, 0, 20)),
    stepped=True,
)

# from the left side to the belly
ERS7_OFF_LEFT = _sequence(
    (
        0.353,
        (130, -10, 68.8),
        (-25.4, -10, 20.6),
        (115, -10, 68.8),
        (-25.4, -10, 20.6),
        (-17.2, -42.6, 20),
    ),
    (
        0.310,
        (97.3, 18.9, 69),
        (-58.6, 0.2, -25),
        (97.3, 18.9, 69),
        (-58.6, 0.2, -25),
        (-17.2, -66.9, 20),
    ),
    (
        0.360,
        (-18.9, 35.8, 15.2),
        (-5.4, 78.1, 44.5),
        (-18.9, 35.8, 15.2),
        (-5.4, 78.1, 44.5),
        (-17.2, -4.7, 20),
    ),
    stepped=True,
)

ERS7_OFF_RIGHT = mirrored(ERS7_OFF_LEFT)
# from the back to the belly, over the right side
ERS7_OFF_BACK = _sequence(
    (0.559, (5.9, -10, -25), (130, -10, -25), (5.9, -10, -25), (115, -10, -25), (-17.2, 70.4, 20)),
    (
        0.349,
        (130, -10, 86.6),
        (130, -10, 52.7),
        (115, -10, 86.6),
        (115, -10, 52.7),
        (-17.2, -63.9, 20),
    ),
    (
        0.420,
        (25.4, 77.5, -10.1),
        (25.9, 88, 105.9),
        (25.4, 77.5, -10.1),
        (25.9, 88, 105.9),
        (-17.2, -46.5, 20),
    ),
    stepped=True,
)

# both forelegs swing
_FORWARD = _sequence(
    (
        0.400,
        (-22.4, 15, 14.5),
        (-22.4, 15, 14.5),
        (-56.5, 5, 118.2),
        (-56.5, 5, 118.2),
        (-7.4, 0, 20),
    ),
    (
        0.250,
        (-22.4, -2.6, 14.5),
        (-22.4, -2.6, 14.5),
        (-56.5, 5, 118.2),
        (-56.5, 5, 118.2),
        (-7.4, 0, 20),
    ),
    (
        0.100,
        (-22.4, -2.6, 14.5),
        (-22.4, -2.6, 14.5),
        (-56.5, 5, 118.2),
        (-56.5, 5, 118.2),
        (-7.4, 0, 20),
    ),
    (
        0.160,
        (113.6, -10, -18.3),
        (113.6, -10, -18.3),
        (58.5, 1.6, 94.5),
        (58.5, 1.6, 94.5),
        (0, 0, 20),
    ),
    (
        0.100,
        (113.6, -10, -18.3),
        (113.6, -10, -18.3),
        (58.5, 1.6, 94.5),
        (58.5, 1.6, 94.5),
        (0, 0, 20),
    ),
    (0.500, (-15, 7, 63), (-15, 7, 63), (-30, 8, 81), (-30, 8, 81), (-20, 0, 20)),
)

# the head sweeps to the left
_HEAD_LEFT = _sequence(
    (0.350, (-7, 42.5, 122), (-7, 42.5, 122), (-28.9, 5.2, 84), (-28.9, 5.2, 84), (0, -88, 27.6)),
    (
        0.400,
        (-7, 42.5, 122),
        (-7, 42.5, 122),
        (-28.9, 5.2, 84),
        (-28.9, 5.2, 84),
        (-56.4, -88, 27.6),
    ),
    (
        0.100,
        (-7, 42.5, 122),
        (-7, 42.5, 122),
        (-28.9, 5.2, 84),
        (-28.9, 5.2, 84),
        (-56.4, -88, 27.6),
    ),
    (
        0.148,
        (-7, 42.5, 122),
        (-7, 42.5, 122),
        (-28.9, 5.2, 84),
        (-28.9, 5.2, 84),
        (-64.8, 88, 28.5),
    ),
    (
        0.100,
        (-7, 42.5, 122),
        (-7, 42.5, 122),
        (-28.9, 5.2, 84),
        (-28.9, 5.2, 84),
        (-64.8, 88, 28.5),
    ),
    (0.500, (-15, 7, 63), (-15, 7, 63), (-30, 8, 81), (-30, 8, 81), (-20, 0, 20)),
)


ERS7_GET_UP = GetUpPlan(
    stand=ERS7_STAND_UP,
    off_left=ERS7_OFF_LEFT,
    off_right=ERS7_OFF_RIGHT,
    off_back_left=mirrored(ERS7_OFF_BACK),
    off_back_right=ERS7_OFF_BACK,
)
# by their codes in controllers/legged/motion.py
ERS7_KICKS = {
    1: Kick(keyframes=_FORWARD, ball=(0.130, 0.0), direction=0.0, distance=2.0),
    2: Kick(keyframes=_HEAD_LEFT, ball=(0.178, 0.080), direction=np.pi / 2, distance=1.6),
    3: Kick(
        keyframes=mirrored(_HEAD_LEFT), ball=(0.178, -0.080), direction=-np.pi / 2, distance=1.6
    ),
}
