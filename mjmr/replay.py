"""Replays: films from trace files, and from the last second of trials that failed."""

import dataclasses
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import MjmrError, one_line
from mjmr.film_options import FilmOptions
from mjmr.footage import Footage, lift_counts
from mjmr.notes import NOTES
from mjmr.trace_file import header, pack, unpack

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation
    from mjmr.parts import Job
    from mjmr.store import Outcome

FAILURE_SPEED = 0.25
_CAPTION = 145  # characters that fit under a film


@dataclass(frozen=True)
class Replay:
    """A file that can be shown.

    Attributes:
        footage: What it shows.
        title: Study, condition and seed.
        speed: Simulated seconds shown a second; None: see :class:`FilmOptions`.
        error: Why the trial failed, in one line; empty if it did not.
    """

    footage: Footage
    title: str
    speed: float | None
    error: str


def failure_file(simulation: "TickedSimulation", job: "Job", failed: "Outcome") -> bytes:
    """Content of the replay file of a trial that failed in ``simulation``.

    It has the states of the last second that passed the divergence guard; what comes after them is
    not a state of anything, MuJoCo may even have put the robots back to the origin. Empty for a
    kinematic simulation, which keeps no such states.
    """
    from mjmr.simulation import Simulation

    if not isinstance(simulation, Simulation):
        return b""
    times, positions, velocities = simulation.last_second.states()
    head = header(
        simulation,
        "failure",
        study=job.study,
        condition=dict(failed.condition),
        seed=failed.seed,
        error=failed.error,
        failed_at=simulation.time,
    )
    arrays = {
        "times": times,
        "positions": positions,
        "velocities": velocities,
        "poses": _poses(simulation, positions),
    }
    return pack(head, simulation.model, arrays)


def _poses(simulation: Any, positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Robots' poses (k, n, 3) at positions (k, nq)."""
    import mujoco

    model, team = simulation.model, simulation.team
    data = mujoco.MjData(model)
    drives = [g.platform.bind(model, g.prefixes) for g in team.groups]
    poses = np.empty((len(positions), team.n, 3))
    for k, row in enumerate(positions):
        data.qpos[:] = row
        mujoco.mj_kinematics(model, data)
        poses[k] = team.stack([drive.poses(data) for drive in drives])
    return poses


def load(path: Path) -> Replay:
    """Read a trace, or the replay of a failed trial.

    What is shown ends before the first state that is not finite.

    Raises:
        MjmrError: The file cannot be read, or is of another version; one sentence says why.
    """
    head, model, arrays = unpack(Path(path))
    try:
        failure = head["kind"] == "failure"
        strange = np.flatnonzero(~np.isfinite(arrays["positions"]).all(axis=1))
        end = int(strange[0]) if len(strange) else len(arrays["positions"])
        if not end:
            raise MjmrError(f"there is nothing to show in {path}: its first state is not finite")
        footage = Footage(
            model=model,
            bounds=np.array(head["bounds"]),
            radii=np.array(head["radii"]),
            period=head["control_period"],
            times=arrays["times"][:end],
            positions=arrays["positions"][:end],
            poses=arrays["poses"][:end],
            notes=_notes(arrays, end),
            captions=_failure_captions(head, end) if failure else arrays["captions"][:end].tolist(),
            lifts=_lifts(arrays, end),
        )
        error = head.get("error") or ""
        title = f"{head['study']} seed {head['seed']}"
    except KeyError as e:
        raise MjmrError(f"{path} is damaged: it has no {e.args[0]}") from e
    except (ValueError, TypeError, IndexError) as e:
        raise MjmrError(f"{path} is damaged: {one_line(e)}") from e
    return Replay(footage, title, FAILURE_SPEED if failure else None, error)


def _lifts(arrays: dict[str, np.ndarray], end: int) -> NDArray[np.int64] | None:
    """How often robots had been lifted (k, n); of files that do not say it None."""
    if "lift_times" not in arrays:
        return None
    rows = zip(*(arrays[f"lift_{name}"] for name in ("times", "robots", "poses")), strict=True)
    return lift_counts(arrays["times"][:end], arrays["poses"][:end], rows)


def _notes(arrays: dict[str, np.ndarray], end: int) -> list[dict[str, np.ndarray]]:
    kept = {name: arrays[f"note_{name}"] for name in NOTES if f"note_{name}" in arrays}
    return [{name: values[k] for name, values in kept.items()} for k in range(end)]


def _failure_captions(head: dict[str, Any], end: int) -> list[str]:
    text = f"failed at t = {head['failed_at']:.3f} s: {head['error']}"
    return [text if len(text) <= _CAPTION else text[: _CAPTION - 3] + "..."] * end


def write_film(replay: Replay, path: Path, options: FilmOptions) -> float:
    """Make a film of a replay, whole or not at all; returns simulated seconds shown a second.

    Raises:
        MissingGLError: No off-screen OpenGL.
        MjmrError: The file cannot be written.
    """
    from mjmr.film import Film

    film = Film(replay.title, dataclasses.replace(options, speed=options.speed or replay.speed))
    film.add(replay.footage)
    try:
        film.write(path)
    except OSError as e:
        raise MjmrError(f"cannot write {path}: {e.strerror or e}") from e
    return film.speed
