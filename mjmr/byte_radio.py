"""A byte radio on a simulation's robots: streams without acknowledgement, with everyone's clocks.

The arithmetic is :class:`mjmr.byte_channel.ByteChannel`'s; range, line of sight and faults are
those of every radio (:mod:`mjmr.reach`).
"""

import math
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.byte_channel import ByteChannel, ByteTiming, Heard
from mjmr.errors import InvalidInputError
from mjmr.reach import Reach

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation

Flags = NDArray[np.bool_]
Ints = NDArray[np.int64]
Check = Callable[[NDArray[np.uint8]], Flags]


class Groups(NamedTuple):
    """Groups that passed their check, in order of arrival.

    Attributes:
        receiver: Index in the team (k,).
        time: When the last byte was read (k,) [s].
        data: Bytes (k, group).
    """

    receiver: Ints
    time: NDArray[np.float64]
    data: NDArray[np.uint8]


class ByteRadio:
    """One frequency for a simulation's team: who sends repeats a message, all others read groups.

    A robot neither acknowledges nor knows who sends. Where two senders reach a receiver at once,
    it reads anything; where none does, zeros. A dead robot is silent and deaf, one whose commands
    are lost is deaf (:mod:`mjmr.faults`). Reach and faults are looked up after every control
    period and count for all of it: whoever reads, and how often, changes nothing. Groups that
    fail the check are dropped and counted; nobody gets to see them.

    Counts are of each receiver (n,), copies: ``groups_read`` while a carrier was there,
    ``groups_dropped`` of them (wrong phases among them), ``groups_accepted``, and, for metrics,
    ``groups_undetected``: accepted though no sender sent them so.
    """

    def __init__(
        self,
        simulation: "TickedSimulation",
        timing: ByteTiming | None = None,
        *,
        check: Check,
        range: float = math.inf,
        visible: Callable[[], Flags] | None = None,
        phase: ArrayLike | None = None,
        inbox: int = 1000,
        name: str = "byte-radio",
    ):
        """Set up a byte radio on every robot of a simulation; its snapshots have it from now on.

        Args:
            simulation: Physical or kinematic.
            timing: Clocks and errors; default: :class:`ByteTiming`'s.
            check: Which of the groups (k, group) a receiver takes (k,).
            range: See :class:`mjmr.reach.Reach` [m].
            visible: See :class:`mjmr.reach.Reach`.
            phase: First read of each receiver (n,) [s]; default: drawn within one cycle.
            inbox: Groups a receiver keeps unread, on average; beyond, the oldest make room.
            name: Of the radio and its random stream.

        Raises:
            InvalidInputError: A negative range, an inbox without room, or a radio of that name
                in this simulation already.
        """
        if inbox != int(inbox) or inbox < 1:
            raise InvalidInputError(f"an inbox has room for 1 group or more; got {inbox}")
        self._simulation, self._check = simulation, check
        self._reach = Reach(simulation, range, visible)
        self.timing, self.name = timing or ByteTiming(), name
        n = self._n = simulation.team.n
        sequence = simulation.streams.sequence(f"radio/{name}")
        self._channel = ByteChannel(n, self.timing, sequence, phase)
        self._room = int(inbox) * n
        self._unread: deque[Groups] = deque()
        self._kept = 0  # groups in it
        self._counts = np.zeros((4, n), dtype=np.int64)
        self._sent = np.zeros(n, dtype=np.int64)  # messages begun
        self._begun = np.zeros(n)
        self._size = np.zeros(n, dtype=np.int64)
        self._told = np.zeros((n, n), dtype=np.int64)  # number of the sender's last message told
        simulation.add_radio(self)
        simulation.observe(self._settle)

    def transmit(self, sender: int, message: bytes, duration: float = math.inf) -> None:
        """Let a robot repeat a message from now on, in place of what it sent before.

        Args:
            sender: Index in the team.
            message: A multiple of the group's bytes, up to 64; empty ends what it sent.
            duration: [s].

        Raises:
            InvalidInputError: No such robot, or a message of another size.
        """
        if not 0 <= sender < self._n:
            raise InvalidInputError(f"no robot {sender} here; valid: 0 to {self._n - 1}")
        self._settle()
        self._channel.transmit(sender, message, self._simulation.time, duration)
        if message:
            self._sent[sender] += 1
            self._begun[sender] = self._simulation.time
            self._size[sender] = len(message)

    def receive(self) -> Groups:
        """Every receiver's groups that arrived since the last call and passed the check."""
        self._settle()
        found = list(self._unread)
        self._unread.clear()
        self._kept = 0
        if not found:
            none = np.empty(0, dtype=np.int64)
            return Groups(none, np.empty(0), np.empty((0, self.timing.group), dtype=np.uint8))
        if len(found) == 1:
            return found[0]
        return Groups(*(np.concatenate(columns) for columns in zip(*found, strict=True)))

    @property
    def groups_read(self) -> Ints:
        """See the class."""
        return self._counts[0].copy()

    @property
    def groups_accepted(self) -> Ints:
        """See the class."""
        return self._counts[1].copy()

    @property
    def groups_dropped(self) -> Ints:
        """See the class."""
        return self._counts[2].copy()

    @property
    def groups_undetected(self) -> Ints:
        """See the class."""
        return self._counts[3].copy()

    def on_air(self) -> Flags:
        """Who is sending now (n,)."""
        return self._channel.on_air(self._simulation.time) & ~self._faulty("silent")

    def state(self) -> Any:
        """Streams, clocks, what is unread and counted, for snapshots."""
        arrays = (self._counts, self._sent, self._begun, self._size, self._told)
        return self._channel.state(), tuple(self._unread), tuple(a.copy() for a in arrays)

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        channel, unread, arrays = state
        self._channel.set_state(channel)
        self._unread = deque(unread)
        self._kept = sum(len(g.time) for g in unread)
        (self._counts, self._sent, self._begun, self._size,
         self._told) = (a.copy() for a in arrays)  # fmt: skip
        self._reach.forget()

    def _faulty(self, kind: str) -> Flags:
        found = self._reach.faulty(kind, self._simulation.time)
        return np.zeros(self._n, dtype=bool) if found is None else found

    def _settle(self) -> None:
        """Read everything up to now."""
        now = self._simulation.time
        if now <= self._channel.now:
            return
        silent, deaf = self._faulty("silent"), self._faulty("deaf")
        reach = self._reach.now() & ~silent[:, None] & ~deaf
        heard = self._channel.listen(now, reach)
        good = np.asarray(self._check(heard.data)) & ~deaf[heard.receiver]
        for row, which in enumerate(
            (heard.carrier, good, heard.carrier & ~good, good & ~heard.intact)
        ):
            np.add.at(self._counts[row], heard.receiver[which], 1)
        if not good.any():
            return
        self._tell(heard, good)
        kept = Groups(heard.receiver[good], heard.time[good], heard.data[good])
        self._unread.append(kept)
        self._kept += len(kept.time)
        while len(self._unread) > 1 and self._kept > self._room:
            self._kept -= len(self._unread.popleft().time)

    def _tell(self, heard: Heard, good: Flags) -> None:
        """Tell traces of the first group of each message that each receiver accepts."""
        if not self._simulation.message_followers:
            return
        for k in np.flatnonzero(good & (heard.sender >= 0)):
            s, r = int(heard.sender[k]), int(heard.receiver[k])
            if self._told[s, r] != self._sent[s]:
                self._told[s, r] = self._sent[s]
                at = np.array([heard.time[k]])
                for follow in self._simulation.message_followers:
                    follow(float(self._begun[s]), at, s, np.array([r]), int(self._size[s]))
