"""The files of single trials: compressed ``.npz`` archives with a header, written by one version.

``header`` is JSON: what the file is, its format, who wrote it, and facts of the trial. ``model`` is
MuJoCo's binary model, which has every asset in it; the other entries are plain arrays.
"""

import io
import json
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from mjmr.errors import InvalidInputError, MjmrError
from mjmr.provenance import versions
from mjmr.reports import to_json

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation

FORMAT = 1
_SAME = ("mjmr", "mujoco")  # states mean nothing to other versions of these


def header(simulation: "TickedSimulation", kind: str, **facts: Any) -> dict[str, Any]:
    """What a file says of itself and its trial.

    Args:
        simulation: Of the trial.
        kind: ``trace`` or ``failure``.
        facts: More, for example study, condition, seed.
    """
    team = simulation.team
    return {
        "kind": kind,
        "format": FORMAT,
        "versions": versions(),
        "simulation": type(simulation).__name__,
        "control_period": simulation.control_period,
        "timestep": simulation.timestep,
        "robots": list(team.names),
        "radii": team.radii.tolist(),
        "bounds": simulation.world.bounds.tolist(),
        **facts,
    }


def pack(head: Mapping[str, Any], model: Any, arrays: Mapping[str, Any]) -> bytes:
    """Content of a file.

    Args:
        head: See :func:`header`.
        model: The compiled ``mujoco.MjModel``.
        arrays: Plain arrays by name.
    """
    binary = np.empty(mujoco.mj_sizeModel(model), dtype=np.uint8)
    mujoco.mj_saveModel(model, None, binary)
    stream = io.BytesIO()
    np.savez_compressed(stream, header=np.array(to_json(dict(head))), model=binary, **arrays)
    return stream.getvalue()


def unpack(path: Path) -> tuple[dict[str, Any], Any, dict[str, np.ndarray]]:
    """Header, model and arrays of a file.

    Raises:
        InvalidInputError: No such file, not one of ours, of another format or version.
        MjmrError: It is damaged.
    """
    try:
        archive = np.load(path, allow_pickle=False)
        if not isinstance(archive, np.lib.npyio.NpzFile):
            raise ValueError("a single array")
        with archive:
            if "header" not in archive:
                raise InvalidInputError(f"{path} is not a trace or replay file: it has no header")
            head = json.loads(str(archive["header"]))
            if not (isinstance(head, dict) and isinstance(head.get("versions", {}), dict)):
                raise ValueError("a header that is none")
            _check(path, head)
            arrays = {name: archive[name] for name in archive.files if name != "header"}
        model = mujoco.MjModel.from_binary_path("model.mjb", {"model.mjb": _bytes(arrays)})
    except FileNotFoundError:
        raise InvalidInputError(f"there is no file {path}") from None
    except OSError as e:
        raise InvalidInputError(f"cannot read {path}: {e.strerror or e}") from e
    except (ValueError, KeyError, EOFError, zipfile.BadZipFile, zlib.error) as e:
        if isinstance(e, MjmrError):
            raise
        raise MjmrError(
            f"{path} is damaged, or no .npz file of mjmr's (mjmr trial --trace FILE.npz and failed "
            "trials of mjmr run leave such files)"
        ) from e
    return head, model, arrays


def _bytes(arrays: dict[str, np.ndarray]) -> bytes:
    return arrays.pop("model").tobytes()


def _check(path: Path, head: Mapping[str, Any]) -> None:
    if head.get("format") != FORMAT:
        raise InvalidInputError(
            f"{path} has format {head.get('format')!r}; this mjmr reads format {FORMAT}"
        )
    here, there = versions(), dict(head.get("versions", {}))
    for package in _SAME:
        if there.get(package) != here[package]:
            raise InvalidInputError(
                f"{path} was written with {package} {there.get(package)}; its states need the same "
                f"version, and this is {here[package]}"
            )
