"""Gaits of the Sony AIBO ERS-7.

Backwards and turning: covariance matrix adaptation (CMA-ES, population 10, 40 and 55 generations,
seed 1) on this project's model, the robot's own legs touching each other, at a timestep of 4 ms
and on frictions 0.6 and 1.0. Speeds at full and partial commands, cross speeds, joints' speeds,
torques, tilt and bounce went into the cost; lift was 12 mm or more.

Sideways: parameters published by a reference run on a model of its own (CMA, own contact on),
checked here. Forwards: those of the same run with feet 5 mm further ahead, 12 for 10 mm of lift
and 2 % more stroke, by hand. Searches of our own found some as fast with smoother joints, which
fell over their forefeet when the head was lowered while they started or reversed; these did not.

What came out is in ``assets/aibo_ers7/README.md``.
"""

import numpy as np

from controllers.legged.gait import Trot
from controllers.legged.gait_set import GaitSet

# joints' angles in which it stands [rad]: the platform's home
ERS7_HOME = tuple(
    np.radians(
        [-15, 7, 63, -15, 7, 63, -30, 8, 81, -30, 8, 81]  # legs: rotator, elevator, knee
        + [-20, 0, 20, -5, 30, 0, 2, 2]  # tilt1, pan, tilt2, mouth, tail, ears
    ).tolist()
)
_FORWARD = GaitSet(
    period=0.502,
    duty=(0.483, 0.431),
    height=(0.102, 0.098),
    lift=(0.012, 0.012),
    ahead=(0.006, -0.029),
    out=(0.013, 0.028),
    gain=1.02,
    clipped=True,
)
_BACKWARD = GaitSet(
    period=0.536,
    duty=(0.38, 0.477),
    height=(0.0872, 0.0977),
    lift=(0.012, 0.012),
    ahead=(0.0404, -0.0033),
    out=(0.0242, 0.0159),
    gain=1.064,
)
_SIDEWAYS = GaitSet(
    period=0.524,
    duty=(0.451, 0.472),
    height=(0.099, 0.097),
    lift=(0.011, 0.010),
    ahead=(0.037, -0.017),
    out=(0.033, 0.027),
)
_TURNING = GaitSet(
    period=0.411,
    duty=(0.38, 0.38),
    height=(0.0983, 0.0956),
    lift=(0.012, 0.0122),
    ahead=(0.019, 0.0),
    out=(0.0226, 0.0275),
    gain=1.151,
)
ERS7_TROT = Trot(
    forward=_FORWARD,
    backward=_BACKWARD,
    sideways=_SIDEWAYS,
    turning=_TURNING,
    full=(0.42, 0.25, 0.185, 2.8),
    home=ERS7_HOME[:12],
)
