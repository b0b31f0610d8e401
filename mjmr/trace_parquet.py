"""Traces as one long Parquet table: a row for every number, for pandas, Polars, DuckDB or R."""

import io
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mjmr.errors import MjmrError
from mjmr.reports import to_json

_POSE = ("x", "y", "yaw")
_TWIST = ("forward", "left", "turn")


def require_pyarrow() -> None:
    """Check for the library.

    Raises:
        MjmrError: It is not there; says how to get it.
    """
    try:
        import pyarrow  # noqa: F401
    except ImportError:
        raise MjmrError(
            "Parquet needs pyarrow: pip install 'mjmr[parquet]', or give a file that ends in .npz"
        ) from None


def pack_parquet(head: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> bytes:
    """Content of a Parquet file with the columns docs/look-closer.md describes.

    Args:
        head: Kept as JSON in the schema's metadata, key ``mjmr``.
        arrays: Of :meth:`mjmr.trace.Trace.arrays`.
    """
    import pyarrow as pa
    import pyarrow.compute  # "pa.compute" is there once it is imported
    import pyarrow.parquet as parquet

    rows = _Rows()
    times, robots = arrays["times"], list(head["robots"])
    for kind, name, fields in (
        ("pose", "poses", _POSE),
        ("twist", "twists", _TWIST),
        ("command", "commands", _TWIST),
        ("set_point", "set_points", _TWIST),
    ):
        rows.add(kind, times, robots, fields, arrays[name])
    for name in [n for n in arrays if n.startswith("note_")]:
        note = name.removeprefix("note_")
        if note == "links":
            rows.add("note", times, robots, [f"{note}_{robot}" for robot in robots], arrays[name])
            continue
        fields = [f"{note}_{axis}" for axis in "xy"]
        if note == "points":  # no robot's
            for i in range(arrays[name].shape[1]):
                own = [f"{note}{i}_{axis}" for axis in "xy"]
                rows.add("note", times, [""], own, arrays[name][:, i : i + 1])
            continue
        rows.add("note", times, robots, fields, arrays[name])
    positions = arrays["positions"]
    rows.add("position", times, [""], [f"qpos{i}" for i in range(positions.shape[1])],
             positions[:, None])  # fmt: skip
    for name in [n for n in arrays if n.startswith("sensor_") and n.endswith("_values")]:
        _add_samples(rows, name.removesuffix("_values"), head["sensors"], arrays)
    _add_contacts(rows, arrays)
    _add_messages(rows, robots, arrays)
    lifted = np.array(robots)[arrays["lift_robots"]]
    rows.add("lift", arrays["lift_times"], [""], _POSE, arrays["lift_poses"][:, None], robot=lifted)
    table = rows.table(pa)
    captions = {
        "time": times,
        "kind": ["caption"] * len(times),
        "text": arrays["captions"].tolist(),
    }
    table = pa.concat_tables([table, pa.table(captions)], promote_options="default")
    stream = io.BytesIO()
    metadata = {"mjmr": to_json(dict(head))}
    parquet.write_table(table.replace_schema_metadata(metadata), stream, compression="zstd")
    return stream.getvalue()


def _add_samples(
    rows: "_Rows", key: str, sensors: Mapping[str, Any], arrays: Mapping[str, np.ndarray]
) -> None:
    source = key.removeprefix("sensor_")
    values = arrays[f"{key}_values"]
    if not len(values):
        return
    carriers = sensors[source]["robots"]
    # a sample has one row a robot; any other is told as one of the whole group
    per_robot = values.ndim >= 2 and values.shape[1] == len(carriers)
    shown = values.reshape(len(values), len(carriers) if per_robot else 1, -1)
    rows.add(
        "sensor",
        arrays[f"{key}_sampled"],
        carriers if per_robot else [""],
        [str(i) for i in range(shown.shape[2])],
        shown,
        source=source,
        number=arrays[f"{key}_numbers"],
        delivered=arrays[f"{key}_delivered"],
    )


def _add_contacts(rows: "_Rows", arrays: Mapping[str, np.ndarray]) -> None:
    counts = np.diff(arrays["contact_offsets"])
    names = np.append(arrays["body_names"], "")  # -1 is the last
    pairs = names[arrays["contact_bodies"].astype(np.int64)].reshape(-1, 2)
    number = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    values = np.column_stack([arrays["contact_distances"], arrays["contact_forces"]])
    times = np.repeat(arrays["times"], counts)
    source = np.array([" | ".join(pair) for pair in pairs.tolist()], np.str_)
    fields = ("distance", "normal_force")
    rows.add("contact", times, [""], fields, values[:, None], source=source, number=number)


def _add_messages(rows: "_Rows", robots: Sequence[str], arrays: Mapping[str, np.ndarray]) -> None:
    names = np.array([*robots, ""])  # -1 is the last
    rows.add(
        "message",
        arrays["message_sent"],
        [""],
        ("bytes",),
        arrays["message_bytes"][:, None, None],
        source=names[arrays["message_sender"]],
        delivered=arrays["message_delivered"],
        robot=names[arrays["message_receiver"]],
    )


class _Rows:
    """Blocks of rows (instants, robots, fields), laid out long."""

    def __init__(self):
        self._blocks: list[dict[str, Any]] = []

    def add(
        self,
        kind: str,
        times: np.ndarray,
        robots: Sequence[str],
        fields: Sequence[str],
        values: np.ndarray,
        source: str | np.ndarray = "",
        number: np.ndarray | None = None,
        delivered: np.ndarray | None = None,
        robot: np.ndarray | None = None,
    ) -> None:
        """Add values (k, robots, fields); what follows them goes with the instants.

        ``robot`` is there for rows whose robot is not the same at every instant.
        """
        k, n, m = values.shape
        spread = np.repeat(np.arange(k), n * m)
        self._blocks.append(
            {
                "time": times[spread],
                "kind": np.full(k * n * m, kind),
                "source": np.broadcast_to(source, k)[spread],
                "robot": np.tile(np.repeat(np.array(robots), m), k)
                if robot is None
                else robot[spread],
                "field": np.tile(np.array(fields), k * n),
                "number": None if number is None else number[spread],
                "delivered": None if delivered is None else delivered[spread],
                "value": values.reshape(-1).astype(np.float64),
            }
        )

    def table(self, pa: Any) -> Any:
        """The long table; what does not apply is null."""
        tables = []
        for block in self._blocks:
            count = len(block["time"])
            columns = {"time": pa.array(block["time"])}
            for name in ("kind", "source", "robot", "field"):
                words = pa.array(block[name].tolist(), pa.string())
                columns[name] = pa.compute.if_else(pa.compute.equal(words, ""), None, words)
            for name, kind in (("number", pa.int64()), ("delivered", pa.float64())):
                given = block[name]
                columns[name] = pa.nulls(count, kind) if given is None else pa.array(given, kind)
            columns["value"] = pa.array(block["value"])
            columns["text"] = pa.nulls(count, pa.string())
            tables.append(pa.table(columns))
        return pa.concat_tables(tables)
