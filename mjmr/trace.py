"""Traces: everything that happened in one trial, for analysis and replay. See docs/look-closer.md.

A trace looks on through observers and sensors' followers, so that the trial gives the same bits.
"""

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError, MjmrError
from mjmr.files import write_atomically
from mjmr.footage import Footage
from mjmr.notes import stack_notes
from mjmr.recording import Recording

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation

Array = NDArray[np.float64]
ENDINGS = (".npz", ".parquet")
LARGEST_SAMPLE = 16_384  # numbers; a camera's pictures are more
# a row for every robot a message is for
MESSAGE_COLUMNS = {
    "message_sent": np.float64,  # [s]
    "message_delivered": np.float64,  # [s]; NaN: lost
    "message_sender": np.int64,  # index in the team
    "message_receiver": np.int64,  # -1: a broadcast out of everybody's reach
    "message_bytes": np.int64,
}
_CONTACT_COLUMNS: dict[str, tuple[Any, tuple[int, ...]]] = {
    "contact_geoms": (np.int32, (2,)),
    "contact_bodies": (np.int32, (2,)),
    "contact_positions": (np.float64, (3,)),
    "contact_distances": (np.float64, ()),
    "contact_forces": (np.float64, ()),
}


def _sensors(simulation: "TickedSimulation") -> list[tuple[str, Any, list[str]]]:
    """Every sensor with its name, ``group/sensor`` or ``world/sensor``, and the robots it is on."""
    world = simulation.world
    found: list[tuple[str, Any, list[str]]] = [
        (f"{group.name}/{name}", sensor, list(group.names))
        for group in world.groups
        for name, sensor in group.sensors.items()
    ]
    return found + [(f"world/{name}", sensor, []) for name, sensor in world.sensors.items()]


class Trace:
    """What a simulation does from now on.

    Attributes:
        recording: What films need of it.
        left_out: Sensors whose samples are not kept, ``group/sensor``, with the reason.
    """

    def __init__(self, simulation: "TickedSimulation"):
        """Start tracing, before the first tick."""
        self.recording = Recording(simulation)
        self.left_out: dict[str, str] = {}
        self._simulation = simulation
        self._twists: list[Array] = []
        self._commands: list[Array] = []
        self._set_points: list[Array] = []
        self._contacts: list[dict[str, np.ndarray]] = []
        self._samples: dict[str, list[tuple[int, float, float, Array]]] = {}
        for name, sensor, _ in _sensors(simulation):
            self._follow(name, sensor)
        self._messages: list[tuple[float, Array, int, Any, int]] = []
        simulation.message_followers.append(lambda *message: self._messages.append(message))
        simulation.observe(self._capture)

    def _follow(self, name: str, sensor: Any) -> None:
        shape = np.shape(sensor.nothing())
        if math.prod(shape) > LARGEST_SAMPLE:
            self.left_out[name] = f"a sample has more than {LARGEST_SAMPLE} numbers"
            return
        self._samples[name] = []

        def hear(number: int, sampled: float, delivered: float, value: Callable[[], Array]) -> None:
            if name in self.left_out:
                return
            try:
                found = np.array(value())
                if found.shape != shape:
                    raise MjmrError(f"a sample has shape {found.shape}, not {shape}")
            except MjmrError as e:  # looking on must not fail a trial that does not read it
                self.left_out[name] = str(e)
                del self._samples[name]
            else:
                self._samples[name].append((number, sampled, delivered, found))

        sensor.follow(hear)

    def _capture(self) -> None:
        simulation = self._simulation
        team, truth = simulation.team, simulation.truth
        self._twists.append(team.stack([truth.twists(g) for g in team.groups]))
        groups = team.groups
        commands = [g.platform.twist_of(g.command.copy()) for g in groups]
        set_points = [g.platform.twist_of(g.executed.copy()) for g in groups]
        self._commands.append(team.stack(commands))
        self._set_points.append(team.stack(set_points))
        if hasattr(simulation, "data"):  # a kinematic simulation has no contacts
            self._contacts.append(_contacts(simulation))

    def arrays(self, footage: Footage) -> dict[str, np.ndarray]:
        """Every array of the file by name; docs/look-closer.md lists them.

        Args:
            footage: Of the recording.
        """
        k, n = len(footage.times), len(footage.radii)
        found: dict[str, np.ndarray] = {
            "times": footage.times,
            "poses": footage.poses,
            "twists": np.stack(self._twists),
            "positions": footage.positions,
            "commands": np.stack(self._commands),
            "set_points": np.stack(self._set_points),
            "captions": np.array(footage.captions, dtype=np.str_),
        }
        for name in sorted({name for note in footage.notes for name in note}):
            found[f"note_{name}"] = stack_notes(name, list(footage.notes), n)
        found |= self._contact_table(footage.model, k)
        for name, samples in self._samples.items():
            found[f"sensor_{name}_numbers"] = np.array([s[0] for s in samples], dtype=np.int64)
            found[f"sensor_{name}_sampled"] = np.array([s[1] for s in samples])
            found[f"sensor_{name}_delivered"] = np.array([s[2] for s in samples])
            found[f"sensor_{name}_values"] = np.array([s[3] for s in samples])
        return found | self._message_table() | self._lift_table()

    def _message_table(self) -> dict[str, np.ndarray]:
        rows = [
            np.column_stack(np.broadcast_arrays(sent, delivered, sender, receivers, size))
            for sent, delivered, sender, receivers, size in self._messages
        ]
        # indices and sizes are exact as floats
        table = np.concatenate([np.empty((0, len(MESSAGE_COLUMNS))), *rows])
        columns = zip(MESSAGE_COLUMNS.items(), table.T, strict=True)
        return {name: column.astype(dtype) for (name, dtype), column in columns}

    def _lift_table(self) -> dict[str, np.ndarray]:
        """A row for every robot that was picked up and put down elsewhere."""
        lifts = self.recording.lifts
        return {
            "lift_times": np.array([time for time, _, _ in lifts], dtype=np.float64),
            "lift_robots": np.array([robot for _, robot, _ in lifts], dtype=np.int64),
            "lift_poses": np.array([pose for _, _, pose in lifts]).reshape(-1, 3),
        }

    def _contact_table(self, model: Any, k: int) -> dict[str, np.ndarray]:
        rows = self._contacts
        counts = [len(row["contact_distances"]) for row in rows] or [0] * k
        table: dict[str, np.ndarray] = {
            "contact_offsets": np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
            "geom_names": np.array([model.geom(i).name for i in range(model.ngeom)], np.str_),
            "body_names": np.array([model.body(i).name for i in range(model.nbody)], np.str_),
        }
        for name, (dtype, shape) in _CONTACT_COLUMNS.items():
            parts = [row[name] for row in rows]
            table[name] = np.concatenate([np.empty((0, *shape), dtype), *parts]).astype(dtype)
        return table

    def save(self, path: Path, facts: Mapping[str, Any]) -> None:
        """Write the file, whole or not at all; its ending says in which form.

        Args:
            path: Ends in one of ``ENDINGS``.
            facts: For the header: study, condition, seed, error.

        Raises:
            InvalidInputError: Another ending, or nothing was traced.
            MjmrError: The file cannot be written, or Parquet was asked for without pyarrow.
        """
        check_ending(path)
        from mjmr.trace_file import header, pack

        simulation = self._simulation
        sensors = {
            name: {"rate": sensor.rate, "latency": sensor.latency, "robots": robots}
            for name, sensor, robots in _sensors(simulation)
        }
        head = header(
            simulation,
            "trace",
            model_xml=simulation.world.to_xml(simulation.timestep),
            sensors=sensors,
            left_out=self.left_out,
            **facts,
        )
        footage = self.recording.footage()
        arrays = self.arrays(footage)
        if path.suffix == ".npz":
            content = pack(head, footage.model, arrays)
        else:
            from mjmr.trace_parquet import pack_parquet

            content = pack_parquet(head, arrays)
        try:
            write_atomically(path, content)
        except OSError as e:
            raise MjmrError(f"cannot write {path}: {e.strerror}") from e


def check_ending(path: Path) -> None:
    """Say early that a trace cannot be written in the form asked for.

    Raises:
        InvalidInputError: An unknown ending.
        MjmrError: Parquet without pyarrow.
    """
    if path.suffix not in ENDINGS:
        raise InvalidInputError(f"a trace's file ends in {' or '.join(ENDINGS)}; got {path}")
    if path.suffix == ".parquet":
        from mjmr.trace_parquet import require_pyarrow

        require_pyarrow()


def _contacts(simulation: Any) -> dict[str, np.ndarray]:
    """Contacts the last physics step worked with, and the normal forces it found [N]."""
    from mjmr.contacts import normal_forces

    model, data = simulation.model, simulation.data
    contact = data.contact
    geoms = contact.geom.copy()
    return {
        "contact_geoms": geoms,
        # a flex has no geom and is -1
        "contact_bodies": np.where(geoms >= 0, model.geom_bodyid[geoms], -1),
        "contact_positions": contact.pos.copy(),
        "contact_distances": contact.dist.copy(),
        "contact_forces": normal_forces(model, data),
    }
