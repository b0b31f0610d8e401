"""Keyframe sequences of joint angles, and a player that gives n robots each its own."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
IDLE = -1  # the sequence of a robot that plays none


@dataclass(frozen=True, kw_only=True)
class Keyframes:
    """Joint angles to go through, one after the other.

    Attributes:
        angles: Of each keyframe (k, j) [rad].
        seconds: Each keyframe's duration (k,) [s].
        stepped: Whether a keyframe's angles are the target all its time, so that the servos go
            there as fast as they can; else the target goes there along a straight line.
    """

    angles: Array
    seconds: Array
    stepped: bool = False

    def __post_init__(self):
        angles, seconds = np.array(self.angles, float), np.array(self.seconds, float)
        if angles.ndim != 2 or not angles.size or seconds.shape != angles.shape[:1]:
            raise InvalidInputError(
                f"keyframes have angles (k, j) and seconds (k,); got {angles.shape} and "
                f"{seconds.shape}"
            )
        if not np.isfinite(angles).all() or not ((seconds > 0) & np.isfinite(seconds)).all():
            raise InvalidInputError("keyframes' angles must be finite, their seconds positive")
        for name, array in (("angles", angles), ("seconds", seconds)):
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    @property
    def duration(self) -> float:
        """Of the whole sequence [s]."""
        return float(self.seconds.sum())

    def mirrored(self, order: Sequence[int], signs: ArrayLike) -> "Keyframes":
        """The same for the other side of the robot.

        Args:
            order: For each joint, the joint it exchanges with (j,).
            signs: What the exchanged angle is multiplied by (j,).
        """
        return replace(self, angles=self.angles[:, list(order)] * np.asarray(signs))


class KeyframePlayer:
    """Plays sequences for n robots, each its own in its own time.

    Attributes:
        sequence: What each robot plays (n,): an index into the sequences, or ``IDLE``.
    """

    def __init__(self, sequences: Sequence[Keyframes], n: int, *, frame: float):
        """Start with nobody playing.

        Args:
            sequences: That can be played, all for the same joints.
            n: Number of robots.
            frame: Between two calls of :meth:`targets` [s].

        Raises:
            InvalidInputError: No sequences, or of different numbers of joints; a bad frame.
        """
        joints = {s.angles.shape[1] for s in sequences}
        if len(joints) != 1 or not frame > 0:
            raise InvalidInputError(
                f"a player needs sequences of one number of joints and a positive frame; got "
                f"{sorted(joints)} joints, {frame} s"
            )
        most = max(len(s.seconds) for s in sequences)
        # padded with the last keyframe, so that a robot holds it beyond the end
        rows = [np.minimum(np.arange(most), len(s.seconds) - 1) for s in sequences]
        self._angles = np.array([s.angles[r] for s, r in zip(sequences, rows, strict=True)])
        ends = [np.cumsum(s.seconds)[r] for s, r in zip(sequences, rows, strict=True)]
        self._ends = np.array(ends)
        self._begins = np.concatenate([np.zeros((len(ends), 1)), self._ends[:, :-1]], axis=1)
        self._stepped = np.array([s.stepped for s in sequences])
        self._frame, self._joints = frame, joints.pop()
        self.sequence = np.full(n, IDLE)
        self._time = np.zeros(n)
        self._from = np.zeros((n, self._joints))

    def start(self, mask: Mask, sequence: ArrayLike, angles: Array) -> None:
        """Let some robots begin, whatever they played before.

        Args:
            mask: Who (n,).
            sequence: What, broadcast to (n,).
            angles: Where their targets are now (n, j) [rad].
        """
        self.sequence = np.where(mask, sequence, self.sequence)
        self._time = np.where(mask, 0.0, self._time)
        self._from = np.where(mask[:, None], angles, self._from)

    def stop(self, mask: Mask) -> None:
        """Let some robots (n,) play nothing."""
        self.sequence = np.where(mask, IDLE, self.sequence)

    @property
    def playing(self) -> Mask:
        """Robots before the end of a sequence (n,)."""
        return (self.sequence != IDLE) & ~self.ended

    @property
    def ended(self) -> Mask:
        """Robots whose sequence is over (n,); they hold its last keyframe until told otherwise."""
        # half a frame of slack: sums of floating point frames
        over = self._time > self._ends[self.sequence, -1] - 0.5 * self._frame
        return (self.sequence != IDLE) & over

    def targets(self) -> Array:
        """Targets for the frame that begins now, (n, j) [rad], then moves on by a frame.

        Rows of robots that play nothing mean nothing.
        """
        # of the end of the frame: a line is at its keyframe when the keyframe's time is over
        self._time = self._time + self._frame
        s, t = self.sequence, self._time[:, None]
        last = self._ends.shape[1] - 1
        k = np.minimum((t > self._ends[s] + 0.5 * self._frame).sum(axis=1), last)
        goal = self._angles[s, k]
        before = np.where((k == 0)[:, None], self._from, self._angles[s, k - 1])
        begin, end = self._begins[s, k], self._ends[s, k]
        share = ((self._time - begin) / np.maximum(end - begin, 1e-9)).clip(0.0, 1.0)
        share = np.where(self._stepped[s], 1.0, share)[:, None]
        return before + share * (goal - before)

    def state(self) -> Any:
        """Who plays what, since when, and from where; copies."""
        return self.sequence.copy(), self._time.copy(), self._from.copy()

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        self.sequence, self._time, self._from = (part.copy() for part in state)
