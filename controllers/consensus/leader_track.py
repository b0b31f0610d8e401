"""Where a leader is and how fast it goes, from two marks seen on it and one's own odometry.

What a follower needs that hears nothing: the card's "leader seen by the front camera", its speeds
estimated. Not in the testbed's paper, which has no formation law.
"""

import numpy as np
from numpy.typing import NDArray

from controllers.estimation.pose_filter import PoseFilter, PoseFilterConfig
from mjmr.errors import InvalidInputError
from mjmr.geometry import rotate, wrap_angle

Array = NDArray[np.float64]


class LeaderTrack:
    """A filter of the leader's pose and twist for each of n followers.

    Every follower's filter lives in the frame of that follower's odometry, so that its own turning
    is not taken for the leader's; how far that frame has drifted does not matter. The leader is
    taken to go on as it does.
    """

    def __init__(
        self, n: int, *, behind: float, ahead: float, period: float, patience: float = 1.0,
        position_noise: float = 0.02, yaw_noise: float = 0.05,
    ):  # fmt: skip
        """Know of nobody.

        Args:
            n: Followers.
            behind: Where on the leader the rear mark is [m] ahead of its origin (negative: behind).
            ahead: Where the front mark is [m] ahead of its origin.
            period: From one step to the next [s].
            patience: For how long a leader that is not seen is taken to go on [s].
            position_noise: Standard deviation of where marks tell that the leader is [m].
            yaw_noise: Of its heading [rad].

        Raises:
            InvalidInputError: The front mark is not ahead of the rear one.
        """
        if not ahead > behind:
            raise InvalidInputError(
                f"the front mark must be ahead of the rear one; got {ahead:g} and {behind:g} m"
            )
        self._behind, self._ahead, self._period = behind, ahead, period
        self._patience = patience
        self._filter = PoseFilter(
            n,
            PoseFilterConfig(
                position_noise=position_noise, yaw_noise=yaw_noise, speed_noise=0.05,
                turn_noise=0.1, start_speed=1.0, start_turn=0.3,
            ),
        )  # fmt: skip
        self._unseen = np.full(n, np.inf)

    def step(self, marks: Array, then: Array, own: Array) -> tuple[Array, Array]:
        """The leader of every follower after one more period.

        Args:
            marks: Distance [m] and bearing [rad] of the rear and the front mark (n, 2, 2) in the
                follower's frame a period ago, when the picture was taken, NaN: not seen; a leader
                is placed by both.
            then: The followers' poses by their odometry at that instant (n, 3) [m, m, rad].
            own: The same now.

        Returns:
            seen (n, 3): where the leader is in the follower's frame [m, m] and its heading less the
            follower's [rad]; and its (forward, turn) (n, 2) [m/s, rad/s]. NaN rows: never seen, or
            not for longer than ``patience``.
        """
        estimate = self._filter
        twist = np.nan_to_num(estimate.twist)
        twist[:, 1] = 0.0  # trucks do not go sideways
        estimate.predict(twist, self._period)
        report = self._report(marks, then)
        estimate.update(report)
        looks = np.isfinite(report[:, 0])
        self._unseen = np.where(looks, 0.0, self._unseen + self._period)
        twist = estimate.twist
        twist[:, 1] = 0.0
        pose, _ = estimate.ahead(np.nan_to_num(twist)[None], self._period)
        way = rotate(pose[:, :2] - own[:, :2], -own[:, 2])
        seen = np.column_stack([way, wrap_angle(pose[:, 2] - own[:, 2])])
        speeds = twist[:, [0, 2]]
        lost = self._unseen > self._patience
        seen[lost], speeds[lost] = np.nan, np.nan
        return seen, speeds

    def _report(self, marks: Array, own: Array) -> Array:
        """The leader's pose (n, 3) in the frame of each follower's odometry."""
        turn = marks[..., 1] + own[:, None, 2]
        places = own[:, None, :2] + marks[..., :1] * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
        line = places[:, 1] - places[:, 0]
        yaw = np.arctan2(line[:, 1], line[:, 0])
        # the middle of both marks is known best
        middle = 0.5 * (self._behind + self._ahead)
        origin = places.mean(axis=1) - middle * np.column_stack([np.cos(yaw), np.sin(yaw)])
        return np.column_stack([origin, yaw])
