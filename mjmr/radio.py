"""Radio: a message bus over the robots of a simulation, with range, loss, latency and counts.

It works on true positions at the instant of sending, as waves do, and hands them to nobody.
"""

import math
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.randomness import SampleNoise
from mjmr.reach import Reach

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Agent = int | str
Payload = bytes | NDArray[Any]


@dataclass(frozen=True, slots=True, eq=False)
class Message:
    """What a robot hears.

    Attributes:
        sender: Index in the team.
        number: Of the message among all its sender's, from 0.
        sent: [s].
        delivered: [s].
        payload: As sent: bytes, or a read-only copy of the array.
    """

    sender: int
    number: int
    sent: float
    delivered: float
    payload: Payload

    @property
    def size(self) -> int:
        """Bytes of the payload."""
        return _size(self.payload)


@dataclass(frozen=True, slots=True)
class _Flight:
    """What is on its way: a message with who will hear it (n,), or a round of values.

    A round's ``heard`` is (receivers, senders).
    """

    ready_step: int
    sent: float
    heard: Flags
    size: int
    message: Message | None
    values: Array | None


class _Losses(SampleNoise):
    _BLOCK = 16  # every sender has a block


class Radio:
    """Messages between the robots of a simulation's team.

    A message reaches every addressee that is in range and in sight when it is sent, unless it is
    lost on the way; nothing tells the sender. It can be read from ``latency`` later on, rounded up
    to whole physics steps and at least one: what is sent in a tick is heard in a later one,
    whoever acts first. What gets lost depends on (stream, sender, message number, receiver) alone.

    Robots are named by their index in the team or by name. A payload is bytes, or an array of
    numbers that counts with the bytes of its own type (float32 saves half); headers are not
    counted. A robot that is dead (:mod:`mjmr.faults`) neither sends nor hears, one whose commands
    are lost hears nothing; either is looked up at sending for the instant of delivery.

    A robot's unread messages are kept up to ``inbox``; then the oldest makes room and counts in
    ``overflowed``.
    """

    def __init__(
        self,
        simulation: "TickedSimulation",
        *,
        range: float = math.inf,
        latency: float = 0.0,
        loss: float = 0.0,
        visible: Callable[[], Flags] | None = None,
        inbox: int = 1000,
        name: str = "radio",
    ):
        """Set up a radio on every robot of a simulation; its snapshots have it from now on.

        Args:
            simulation: Physical or kinematic.
            range: Between the origins of two robots' bases, inclusive [m].
            latency: [s].
            loss: Probability that an addressee in reach does not hear a message.
            visible: Called when something is sent, for (n, n) flags over the team, sender first:
                whether a line of sight between two robots is free, to be read from the simulation,
                not from its guarded truth; None: waves go through everything.
            inbox: Messages a robot keeps until it reads them.
            name: Of the radio and its random stream.

        Raises:
            InvalidInputError: A negative range or latency, a loss outside [0, 1], an inbox
                without room, or a radio of that name in this simulation already.
        """
        if not 0 <= latency < math.inf:
            raise InvalidInputError(f"a radio's latency is 0 or more and finite; got {latency} s")
        if not 0 <= loss <= 1:
            raise InvalidInputError(f"loss is a probability, 0 to 1; got {loss}")
        if inbox != int(inbox) or inbox < 1:
            raise InvalidInputError(f"an inbox has room for 1 message or more; got {inbox}")
        self._simulation, self._team = simulation, simulation.team
        n = self._team.n
        self._reach = Reach(simulation, range, visible)
        self.range, self.latency, self.loss = float(range), float(latency), float(loss)
        self.name = name
        self._inbox = int(inbox)
        self._index = {name: i for i, name in enumerate(self._team.names)}
        self._latency_steps = max(1, simulation.steps_until(latency))
        sequences = simulation.streams.sequence(f"radio/{name}").spawn(n)
        self._losses = [_Losses(s, (n,), "uniform") for s in sequences]
        self._numbers = np.zeros(n, dtype=np.int64)
        self._flights: deque[_Flight] = deque()
        self._inboxes: list[deque[Message]] = [deque() for _ in self._team.names]
        self._counts = np.zeros((5, n), dtype=np.int64)
        self._latest: tuple[Array, Array] | None = None
        simulation.add_radio(self)

    def send(self, sender: Agent, payload: Payload, to: Agent | Iterable[Agent]) -> None:
        """Send a message to one robot or several.

        Raises:
            UnknownNameError: No such robot.
            InvalidInputError: A payload that is neither bytes nor an array of numbers, or a robot
                that sends to itself.
        """
        origin = self._agent(sender)
        addressed = np.zeros(self._team.n, dtype=bool)
        agents = [to] if isinstance(to, (str, int, np.integer)) else to
        addressed[[self._agent(agent) for agent in agents]] = True
        if addressed[origin]:
            raise InvalidInputError(f"{self._team.names[origin]} cannot send to itself")
        self._send(origin, payload, addressed, broadcast=False)

    def broadcast(self, sender: Agent, payload: Payload) -> None:
        """Send a message to everybody else; errors as in :meth:`send`."""
        origin = self._agent(sender)
        addressed = np.ones(self._team.n, dtype=bool)
        addressed[origin] = False
        self._send(origin, payload, addressed, broadcast=True)

    def receive(self, agent: Agent) -> list[Message]:
        """Messages a robot has heard and not read yet, in the order they were sent.

        Raises:
            UnknownNameError: No such robot.
        """
        self._settle()
        box = self._inboxes[self._agent(agent)]
        found = list(box)
        box.clear()
        return found

    def broadcast_arrays(self, values: ArrayLike, senders: ArrayLike | None = None) -> None:
        """Let every robot broadcast one row of numbers; for states told at every tick.

        Rows come out of :meth:`latest`, not of :meth:`receive`.

        Args:
            values: Shape (n, c), the same c at every call; counts c times the bytes of its type.
            senders: Flags (n,) of who sends; default: everybody.

        Raises:
            InvalidInputError: Another shape, or no numbers.
        """
        n = self._team.n
        given = np.asarray(values)
        rows = _numbers(given).astype(np.float64)
        columns = rows.shape[1] if rows.ndim == 2 else -1
        if rows.ndim != 2 or len(rows) != n:
            raise InvalidInputError(f"values must have shape ({n}, c); got {rows.shape}")
        who = np.ones(n, dtype=bool) if senders is None else np.array(senders)
        if who.shape != (n,) or who.dtype != bool:
            raise InvalidInputError(f"senders are {n} flags; got {who.dtype} of shape {who.shape}")
        if self._latest is None:
            self._latest = np.full((n, n, columns), np.nan), np.full((n, n), np.nan)
        if columns != self._latest[0].shape[2]:
            raise InvalidInputError(
                f"values must have the {self._latest[0].shape[2]} columns they had before; "
                f"got {columns}"
            )
        step, time = self._now()
        silent = self._reach.faulty("silent", time)
        numbers = self._numbers.copy()
        self._numbers[who] += 1
        if silent is not None:
            who = who & ~silent
        size = columns * given.dtype.itemsize
        self._counts[0, who] += 1
        self._counts[1, who] += size
        reached = self._reach.now() & who[:, None]
        np.fill_diagonal(reached, False)
        heard = reached.copy()
        if self.loss > 0:
            for i in np.flatnonzero(who):
                heard[i] &= self._losses[i].sample(int(numbers[i])) >= self.loss
        ready = step + self._latency_steps
        delivered = ready * self._simulation.timestep
        deaf = self._reach.faulty("deaf", delivered)
        if deaf is not None:
            heard &= ~deaf
        for i in np.flatnonzero(who) if self._simulation.message_followers else ():
            self._tell(int(i), time, delivered, size, reached[i], heard[i])
        self._flights.append(_Flight(ready, time, heard.T, size, None, rows))

    def latest(self) -> tuple[Array, Array]:
        """The newest row each robot has heard of each other one by :meth:`broadcast_arrays`.

        Returns:
            Values (n, n, c), receiver first, and the instants they were sent (n, n) [s]; NaN where
            nothing was ever heard, so on the diagonal. New arrays.

        Raises:
            InvalidInputError: Nobody has broadcast arrays yet.
        """
        if self._latest is None:
            raise InvalidInputError("there is nothing to hear before the first broadcast_arrays")
        self._settle()
        values, sent = self._latest
        return values.copy(), sent.copy()

    @property
    def messages_sent(self) -> NDArray[np.int64]:
        """Of each robot (n,): messages, a broadcast being one; a copy, as all counts are."""
        return self._count(0)

    @property
    def bytes_sent(self) -> NDArray[np.int64]:
        """Payload of each robot's messages (n,), a broadcast's once."""
        return self._count(1)

    @property
    def messages_received(self) -> NDArray[np.int64]:
        """Messages each robot (n,) has heard by now, read or not."""
        return self._count(2)

    @property
    def bytes_received(self) -> NDArray[np.int64]:
        """Payload of the messages each robot (n,) has heard by now."""
        return self._count(3)

    @property
    def overflowed(self) -> NDArray[np.int64]:
        """Messages each robot (n,) has heard and lost unread, because its inbox was full."""
        return self._count(4)

    def state(self) -> Any:
        """What is on its way, unread and counted, for snapshots; nothing in it is written to."""
        self._settle()
        boxes = tuple(tuple(box) for box in self._inboxes)
        latest = None if self._latest is None else tuple(a.copy() for a in self._latest)
        return tuple(self._flights), boxes, self._numbers.copy(), self._counts.copy(), latest

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        flights, boxes, numbers, counts, latest = state
        self._flights = deque(flights)
        self._inboxes = [deque(box) for box in boxes]
        self._numbers, self._counts = numbers.copy(), counts.copy()
        self._latest = None if latest is None else tuple(a.copy() for a in latest)
        self._reach.forget()

    def _send(self, origin: int, payload: Payload, addressed: Flags, *, broadcast: bool) -> None:
        if isinstance(payload, (bytearray, memoryview)):
            payload = bytes(payload)
        elif isinstance(payload, np.ndarray):
            payload = _numbers(payload).copy()
            payload.setflags(write=False)
        elif not isinstance(payload, bytes):
            raise InvalidInputError(
                f"a payload is bytes or an array of numbers; got {type(payload).__name__}"
            )
        step, time = self._now()
        number = int(self._numbers[origin])
        self._numbers[origin] += 1
        silent = self._reach.faulty("silent", time)
        if silent is not None and silent[origin]:
            return
        size = _size(payload)
        self._counts[0, origin] += 1
        self._counts[1, origin] += size
        reached = addressed & self._reach.now()[origin]
        heard = reached.copy()
        if self.loss > 0:
            heard &= self._losses[origin].sample(number) >= self.loss
        ready = step + self._latency_steps
        delivered = ready * self._simulation.timestep
        deaf = self._reach.faulty("deaf", delivered)
        if deaf is not None:
            heard &= ~deaf
        if self._simulation.message_followers:
            shown = reached if broadcast else addressed
            self._tell(origin, time, delivered, size, shown, heard)
        if heard.any():
            message = Message(origin, number, time, delivered, payload)
            self._flights.append(_Flight(ready, time, heard, size, message, None))

    def _settle(self) -> None:
        """Deliver what has arrived by now."""
        now = self._simulation.step
        while self._flights and self._flights[0].ready_step <= now:
            flight = self._flights.popleft()
            if flight.message is not None:
                self._counts[2] += flight.heard
                self._counts[3] += flight.heard * flight.size
                for i in np.flatnonzero(flight.heard):
                    box = self._inboxes[i]
                    if len(box) == self._inbox:
                        box.popleft()
                        self._counts[4, i] += 1
                    box.append(flight.message)
            elif flight.values is not None and self._latest is not None:
                count = flight.heard.sum(axis=1)
                self._counts[2] += count
                self._counts[3] += count * flight.size
                values, sent = self._latest
                np.copyto(values, flight.values[None], where=flight.heard[:, :, None])
                sent[flight.heard] = flight.sent

    def _tell(
        self, sender: int, time: float, delivered: float, size: int, shown: Flags, heard: Flags
    ) -> None:
        """Tell traces of a message: a row for each robot shown, one of receiver -1 for none."""
        receivers = np.flatnonzero(shown) if shown.any() else np.array([-1])
        arrivals = np.where(np.append(heard, False)[receivers], delivered, np.nan)
        for follow in self._simulation.message_followers:
            follow(time, arrivals, sender, receivers, size)

    def _agent(self, agent: Agent) -> int:
        if isinstance(agent, str):
            if agent not in self._index:
                raise UnknownNameError("robot", agent, self._team.names)
            return self._index[agent]
        if isinstance(agent, (int, np.integer)) and 0 <= agent < self._team.n:
            return int(agent)
        raise UnknownNameError("robot", agent, [*self._team.names, f"0 to {self._team.n - 1}"])

    def _count(self, row: int) -> NDArray[np.int64]:
        self._settle()
        return self._counts[row].copy()

    def _now(self) -> tuple[int, float]:
        """This step and its instant [s]; what has arrived is delivered before anything is sent."""
        self._settle()
        return self._simulation.step, self._simulation.time


def _numbers(array: NDArray[Any]) -> NDArray[Any]:
    if array.dtype.kind not in "fiub":
        raise InvalidInputError(
            f"an array that is sent has real numbers or flags; got {array.dtype}"
        )
    return array


def _size(payload: Payload) -> int:
    return len(payload) if isinstance(payload, bytes) else payload.nbytes
