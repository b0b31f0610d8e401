"""Bus: the CAN bus inside every robot of a group, and the manager that watches its devices.

It is abstract: no voltages, no bit errors. What is kept of CAN: messages have identifiers, unique
on a bus, and no addresses; of what waits the lowest identifier goes first; a bus carries so many
bits a second; devices come and go while it runs.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, UnknownNameError

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
RESERVED = 0x20  # identifiers below are the manager's: what it asks goes first
HIGHEST = 0x7FF
CHANGES = ("added", "removed", "unhealthy", "healthy")


@dataclass(frozen=True, slots=True)
class Change:
    """What the manager reports.

    Attributes:
        time: Of the report [s].
        robot: Index in the group.
        device: Name.
        kind: One of ``CHANGES``.
    """

    time: float
    robot: int
    device: str
    kind: str


@dataclass(slots=True)
class _Device:
    name: str
    identifier: int
    read: Callable[[], Any]
    sampled_at: Callable[[], float]
    bits: int
    last: float = math.nan


def frame_bits(size: int) -> int:
    """Bits of the frames that carry ``size`` bytes, 8 a frame, stuffed as badly as can be."""
    whole, rest = divmod(size, 8)
    return whole * _bits(8) + (_bits(rest) if rest or not whole else 0)


def _bits(size: int) -> int:
    return 47 + 8 * size + (34 + 8 * size - 1) // 4


class Bus:
    """One bus on each of n robots, all with the same kinds of devices.

    Devices publish; whoever is on the robot reads the newest message of a name. A device holds one
    message: of two samples one is lost, and counted, the older if none of it has been sent, else
    the newer. From step to step the bus is handed out anew, so that of a long message the rest may
    be overtaken.

    The manager asks every device four times a second whether it is there and well, by messages that
    go first. It reports what has not answered for half a second, so within one second, and what
    answers again.

    Attributes:
        n: Robots.
        bit_rate: [bit/s].
        changes: All that the manager has reported, in order.
        lost: Samples of each robot and device that were never sent (n, d).
    """

    POLL = 0.25  # s, from question to question
    SILENCE = 0.5  # s, without an answer, after which a device is gone

    def __init__(self, simulation: "TickedSimulation", n: int, *, bit_rate: float = 500e3):
        """Set up n buses without devices; snapshots of the simulation have them from now on.

        Args:
            simulation: Whose time it is.
            n: Robots.
            bit_rate: Of each bus [bit/s].

        Raises:
            InvalidInputError: No robots, or a rate that is not positive and finite.
        """
        if n != int(n) or n < 1:
            raise InvalidInputError(f"buses are those of 1 robot or more; got {n}")
        if not 0 < bit_rate < math.inf:
            raise InvalidInputError(f"a bus's bit rate must be positive; got {bit_rate} bit/s")
        self.n, self.bit_rate = int(n), float(bit_rate)
        self.changes: list[Change] = []
        self.lost = np.zeros((self.n, 0), dtype=np.int64)
        self._simulation = simulation
        self._devices: list[_Device] = []
        self._index: dict[str, int] = {}
        self._plugged = self._well = self._known = self._known_well = np.ones((self.n, 0), bool)
        self._waiting = self._asked = np.zeros((self.n, 0))  # bits yet to be sent
        self._answered = self._sent_at = np.zeros((self.n, 0))
        self._outbox: list[Any] = []
        self._outbox_at = np.zeros((self.n, 0))
        self._inbox: list[Any] = []
        self._time, self._next_poll = simulation.time, simulation.time
        simulation.buses.append(self)

    def attach(
        self,
        name: str,
        identifier: int,
        read: Callable[[], ArrayLike],
        sampled_at: Callable[[], float],
        *,
        size: int,
    ) -> None:
        """Put a device on every bus.

        Args:
            name: By which it is read.
            identifier: Of its messages; the lower, the sooner it is sent.
            read: Returns its newest reading, first axis n; called when there is a new sample.
            sampled_at: Returns the instant of that [s], NaN before the first.
            size: Bytes of a message; more than 8 take several frames.

        Raises:
            InvalidInputError: A name or identifier that is taken, an identifier outside
                ``RESERVED`` to ``HIGHEST``, or a size below 0.
        """
        if name in self._index:
            raise InvalidInputError(f"there is a device named {name!r} on this bus already")
        if not (identifier == int(identifier) and RESERVED <= identifier <= HIGHEST):
            raise InvalidInputError(
                f"an identifier lies within {RESERVED:#x} to {HIGHEST:#x}; got {identifier:#x} "
                f"for {name!r}"
            )
        for device in self._devices:
            if device.identifier == identifier:
                raise InvalidInputError(
                    f"identifiers are unique on a bus; {identifier:#x} is {device.name!r}'s, "
                    f"{name!r} needs another"
                )
        if size != int(size) or size < 0:
            raise InvalidInputError(f"a message has 0 bytes or more; got {size}")
        self._devices.append(_Device(name, int(identifier), read, sampled_at, frame_bits(size)))
        self._index[name] = len(self._devices) - 1
        column = np.ones((self.n, 1), dtype=bool)
        self._plugged, self._well, self._known, self._known_well = (
            np.hstack([flags, column])
            for flags in (self._plugged, self._well, self._known, self._known_well)
        )
        nil = np.zeros((self.n, 1))
        self._waiting, self._asked = np.hstack([self._waiting, nil]), np.hstack([self._asked, nil])
        self._answered = np.hstack([self._answered, nil + self._time])
        self._sent_at = np.hstack([self._sent_at, np.full((self.n, 1), np.nan)])
        self.lost = np.hstack([self.lost, np.zeros((self.n, 1), dtype=np.int64)])
        self._outbox.append(None)
        self._outbox_at = np.hstack([self._outbox_at, np.full((self.n, 1), np.nan)])
        self._inbox.append(None)
        self._order = np.argsort([device.identifier for device in self._devices])

    def unplug(self, name: str, rows: ArrayLike) -> None:
        """Pull a device's plug on robots ``rows``: it sends nothing and answers nothing."""
        self._plugged = self._with(self._plugged, name, rows, False)
        self._waiting[np.asarray(rows), self._number(name)] = 0.0

    def plug(self, name: str, rows: ArrayLike) -> None:
        """Put it in again."""
        self._plugged = self._with(self._plugged, name, rows, True)

    def fail(self, name: str, rows: ArrayLike) -> None:
        """Let its self-test fail on robots ``rows``: it says so and sends nothing."""
        self._well = self._with(self._well, name, rows, False)

    def mend(self, name: str, rows: ArrayLike) -> None:
        """Let it pass again."""
        self._well = self._with(self._well, name, rows, True)

    def step(self) -> None:
        """Carry what there is to carry since the last step; call it at every tick."""
        time = self._simulation.time
        budget = np.full(self.n, self.bit_rate * max(time - self._time, 0.0))
        self._time = time
        if not self._devices:
            return
        # what was there when the interval began; what comes now has the next one to be sent in
        asked = self._asked > 0.0
        self._asked, budget = _carry(self._asked, np.arange(len(self._devices)), budget)
        answered = asked & (self._asked == 0.0) & self._plugged
        self._answered = np.where(answered, time, self._answered)
        waiting = self._waiting > 0.0
        self._waiting, _ = _carry(self._waiting, self._order, budget)
        self._deliver(waiting & (self._waiting == 0.0))
        self._manage(time, answered)
        self._collect()
        if time >= self._next_poll - 1e-9:
            self._next_poll = max(self._next_poll + self.POLL, time)
            # question and answer; who is not there leaves the question unanswered
            self._asked = np.full_like(self._asked, 2.0 * frame_bits(1))

    def read(self, name: str) -> Array:
        """Newest message of a device that has arrived on each robot, first axis n; NaN: none yet.

        Raises:
            UnknownNameError: No such device; lists them.
            InvalidInputError: Nobody has sent anything yet under this name.
        """
        found = self._inbox[self._number(name)]
        if found is None:
            raise InvalidInputError(f"nothing has come from {name!r} yet; see age()")
        return found.copy()

    def age(self, name: str) -> Array:
        """How long ago what :meth:`read` returns was sampled (n,) [s]; inf: nothing came yet."""
        at = self._sent_at[:, self._number(name)]
        return np.where(np.isnan(at), np.inf, self._time - at)

    def present(self, name: str) -> Flags:
        """Whether the manager takes a device for there and well (n,)."""
        k = self._number(name)
        return self._known[:, k] & self._known_well[:, k]

    def _collect(self) -> None:
        """Take new samples into the outboxes."""
        for k, device in enumerate(self._devices):
            at = device.sampled_at()
            if math.isnan(at) or at == device.last:
                continue
            device.last = at
            speaks = self._plugged[:, k] & self._well[:, k]
            self.lost[:, k] += speaks & (self._waiting[:, k] > 0)
            values = np.array(device.read(), dtype=np.float64)
            if len(values) != self.n:
                raise InvalidInputError(
                    f"{device.name!r} must read {self.n} rows; got shape {values.shape}"
                )
            if self._outbox[k] is None:
                self._outbox[k] = np.full(values.shape, np.nan)
            begun = (self._waiting[:, k] > 0) & (self._waiting[:, k] < device.bits)
            taken = speaks & ~begun
            self._outbox[k] = self._outbox[k].copy()
            self._outbox[k][taken] = values[taken]
            self._outbox_at[taken, k] = at
            self._waiting[taken, k] = float(device.bits)

    def _deliver(self, arrived: Flags) -> None:
        for k in np.flatnonzero(arrived.any(axis=0)):
            values = self._outbox[k]
            if self._inbox[k] is None:
                self._inbox[k] = np.full(values.shape, np.nan)
            self._inbox[k] = self._inbox[k].copy()
            self._inbox[k][arrived[:, k]] = values[arrived[:, k]]
            self._sent_at[arrived[:, k], k] = self._outbox_at[arrived[:, k], k]

    def _manage(self, time: float, answered: Flags) -> None:
        gone = time - self._answered > self.SILENCE
        well = np.where(answered, self._well, self._known_well)
        for flags, kind in (
            (self._known & gone, "removed"),
            (~self._known & ~gone, "added"),
            (self._known_well & ~well & ~gone, "unhealthy"),
            (~self._known_well & well & ~gone, "healthy"),
        ):
            if flags.any():
                self.changes += [
                    Change(time, int(i), self._devices[k].name, kind) for i, k in np.argwhere(flags)
                ]
        self._known, self._known_well = ~gone, well

    def state(self) -> Any:
        """What the buses remember, for snapshots."""
        arrays = (
            self._plugged, self._well, self._known, self._known_well, self._waiting, self._asked,
            self._answered, self._sent_at, self.lost, self._outbox_at,
        )  # fmt: skip
        boxes = [list(self._outbox), list(self._inbox)]
        last = [device.last for device in self._devices]
        return [a.copy() for a in arrays], boxes, last, self._time, self._next_poll, [*self.changes]

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        arrays, boxes, last, self._time, self._next_poll, changes = state
        (
            self._plugged, self._well, self._known, self._known_well, self._waiting, self._asked,
            self._answered, self._sent_at, self.lost, self._outbox_at,
        ) = (a.copy() for a in arrays)  # fmt: skip
        self._outbox, self._inbox = (list(box) for box in boxes)
        for device, at in zip(self._devices, last, strict=True):
            device.last = at
        self.changes = [*changes]

    def _number(self, name: str) -> int:
        if name not in self._index:
            raise UnknownNameError("device", name, self._index)
        return self._index[name]

    def _with(self, flags: Flags, name: str, rows: ArrayLike, value: bool) -> Flags:
        fresh = flags.copy()
        fresh[np.asarray(rows), self._number(name)] = value
        return fresh


def _carry(waiting: Array, order: NDArray[np.int64], budget: Array) -> tuple[Array, Array]:
    """Bits (n, d) that still wait, and the budget (n,) left, after the first in ``order`` went."""
    queue = waiting[:, order]
    before = np.cumsum(queue, axis=1) - queue
    sent = np.clip(budget[:, None] - before, 0.0, queue)
    left = np.empty_like(waiting)
    left[:, order] = queue - sent
    return left, budget - sent.sum(axis=1)
