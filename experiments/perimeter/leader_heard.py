"""Followers that hear their leader: poses that all report by radio, and the leader's commands."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.geometry import rotate, wrap_angle
from mjmr.radio import Radio
from mjmr.sensors.localizer import Localizer
from mjmr.world import World

if TYPE_CHECKING:
    from mjmr.group import Group

Array = NDArray[np.float64]


class LeaderHeard:
    """Where each follower's leader is, from two poses with noise, one of them by radio.

    What is heard is a tick old: it is taken as it is, or moved on by the speeds that came with it.
    """

    def __init__(self, world: World, trucks: "Group", condition: Mapping[str, Any]):
        """Mount the localizers; the first of the trucks is the leader."""
        del world
        trucks.mount(Localizer(rate=10.0, position_noise=0.005, yaw_noise=0.005), "localizer")
        self._trucks, self._condition = trucks, condition

    def start(self, simulation: Any) -> None:
        """Switch the radios on."""
        self._radio = Radio(simulation, range=self._condition["d_com"])

    def step(self, now: float, leads: Array) -> tuple[Array, Array]:
        """What the followers know now; afterwards everybody speaks.

        Args:
            now: [s].
            leads: What the leader does (2,) [m/s, rad/s], which it tells.

        Returns:
            seen (n, 3): where the leader is in the follower's frame [m, m] and its heading less the
            follower's [rad]; and its (forward, turn) (n, 2). NaN rows: not known.
        """
        radio, pose = self._radio, self._trucks.localizer.read()
        n = len(pose) - 1
        seen, speeds = np.full((n, 3), np.nan), np.full((n, 2), np.nan)
        if radio.messages_sent.any() and np.isfinite(pose).all():
            told, sent = radio.latest()
            heard = told[1:, 0]  # what each follower heard of the leader
            if self._condition["heard"] == "extrapolated":
                _move_on(heard, now - sent[1:, 0])
            way = rotate(heard[:, :2] - pose[1:, :2], -pose[1:, 2])
            seen = np.column_stack([way, wrap_angle(heard[:, 2] - pose[1:, 2])])
            speeds = heard[:, 3:]
        radio.broadcast_arrays(np.column_stack([pose, np.tile(leads, (n + 1, 1))]))
        return seen, speeds


def _move_on(heard: Array, age: Array) -> None:
    """Put the leader (k, 5) where it has got to in ``age`` [s] by the speeds it told."""
    heard[:, 2] += heard[:, 4] * age
    heard[:, :2] += rotate(np.column_stack([heard[:, 3] * age, 0.0 * age]), heard[:, 2])
