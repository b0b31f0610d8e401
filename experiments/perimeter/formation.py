"""A leader and two followers by the separation-bearing law (not in the paper)."""

import contextlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from controllers.consensus.leader_follower import SeparationBearing
from experiments.perimeter.checks import SETTLE
from experiments.perimeter.leader_heard import LeaderHeard
from experiments.perimeter.leader_seen import LeaderSeen
from mjmr.geometry import wrap_angle
from mjmr.robots.tamiya_txt1 import TamiyaTXT1
from mjmr.world import World

PERIOD = 0.1
HALF_LONG, HALF_WIDE = 60.0, 30.0  # m, of the hall
SPEED = 0.8  # m/s, of the leader
RADIUS = 10.0  # m, of the circle and of the eight's two
SEPARATION, BEARINGS = 2.0, np.radians([150.0, -150.0])  # of the two followers
RAMP = 8.0  # s, in which the leader's curvature changes on the smooth eight
AHEAD = 0.3  # m, of the followers' reference point before the axle


def formation(condition: Mapping[str, Any], seed: int) -> dict[str, Any]:
    """Errors of two followers that start off their places and follow a leader on a path.

    They hear where it is and what it was commanded, or (``heard=nothing``) see it.
    """
    rng = np.random.default_rng(np.random.SeedSequence([seed, 14]))
    world = World.rectangle(2 * HALF_LONG, 2 * HALF_WIDE, wall_height=0.6, floor="concrete")
    path, start = start_of(condition["path"])
    places = start[:2] + SEPARATION * np.column_stack([np.cos(BEARINGS), np.sin(BEARINGS)])
    places = places - [AHEAD, 0.0] + rng.uniform(-0.3, 0.3, (2, 2))
    yaws = rng.uniform(-0.2, 0.2, 2)
    poses = np.vstack([start, np.column_stack([places, yaws])])
    trucks = world.add_group(TamiyaTXT1, poses)
    # what the followers go by
    leader: Any = (LeaderSeen if condition["heard"] == "nothing" else LeaderHeard)(
        world, trucks, condition
    )
    simulation, meter = _simulation(condition, world, seed)
    leader.start(simulation)
    law = [SeparationBearing(separation=SEPARATION, bearing=float(b), ahead=AHEAD)
           for b in BEARINGS]  # fmt: skip
    track: list[np.ndarray] = []
    simulation.observe(lambda: track.append(simulation.truth.poses(trucks)))
    duration = min(condition["duration"], 110.0 if path == "straight" else 160.0)
    with contextlib.closing(simulation):
        for now in simulation.ticks(duration):
            leads = np.array([SPEED, _turn(path, now)])
            seen, speeds = leader.step(now, leads)
            command = np.zeros((3, 2))
            command[0] = leads
            for k in range(2):
                if np.isfinite(seen[k]).all():
                    command[k + 1] = law[k].command(seen[k : k + 1], speeds[k : k + 1])[0]
            trucks.drive(command)
    return {"time_s": duration, **_errors(np.stack(track)), **_contacts(meter)}


def start_of(name: str) -> tuple[str, np.ndarray]:
    """Form of a path, and pose (3,) at which its leader starts.

    From y = -10 m the second circle of the eight reaches a wall, and claims were committed with it;
    ``-middle`` starts in the middle of the hall.
    """
    path = name.removesuffix("-middle")
    return path, np.array([-50.0 if path == "straight" else 0.0, 0.0 if path != name else -10.0,
                           0.0])  # fmt: skip


def _turn(path: str, now: float) -> float:
    """Turn rate of the leader [rad/s]: after 10 s straight."""
    if path == "straight" or now < 10.0:
        return 0.0
    lap = 2.0 * np.pi * RADIUS / SPEED
    since = (now - 10.0) % (2.0 * lap)
    side = 1.0 if path == "circle" or since < lap else -1.0
    share = 1.0
    if path == "eight-smooth":
        # from one circle to the other the curvature goes through nought
        way = min(since, abs(since - lap), 2.0 * lap - since) / (RAMP / 2.0)
        share = min(way, (now - 10.0) / RAMP, 1.0)
    return SPEED / RADIUS * share * side


def _errors(track: np.ndarray) -> dict[str, float]:
    """Of separation [m] and bearing [deg] over time (k, 3, 3), after they have settled."""
    late = track[round(SETTLE / PERIOD) :]
    leader, followers = late[:, :1], late[:, 1:]
    heading = np.stack([np.cos(followers[..., 2]), np.sin(followers[..., 2])], axis=-1)
    way = followers[..., :2] + AHEAD * heading - leader[..., :2]
    apart = np.hypot(way[..., 0], way[..., 1])
    bearing = wrap_angle(np.arctan2(way[..., 1], way[..., 0]) - leader[..., 2] - BEARINGS)
    # where each should have been
    wanted = leader[..., 2] + BEARINGS
    place = SEPARATION * np.stack([np.cos(wanted), np.sin(wanted)], axis=-1)
    off = np.hypot(*(way - place).transpose(2, 0, 1))
    return {
        "separation_rms_m": float(np.sqrt(((apart - SEPARATION) ** 2).mean())),
        "bearing_rms_deg": float(np.degrees(np.sqrt((bearing**2).mean()))),
        "place_rms_m": float(np.sqrt((off**2).mean())),
        "place_worst_m": float(off.max()),
    }


def _simulation(condition: Mapping[str, Any], world: World, seed: int) -> tuple[Any, Any]:
    options = {"seed": seed, "control_period": PERIOD}
    if condition["mode"] == "unicycle":
        from mjmr.kinematics import KinematicSimulation

        return KinematicSimulation(world, **options), None
    from mjmr.metrics import ContactMeter
    from mjmr.simulation import Simulation

    simulation = Simulation(world, dt_max=condition["dt_ms"] / 1000.0, **options)
    return simulation, ContactMeter(simulation)


def _contacts(meter: Any) -> dict[str, Any]:
    """Of trucks with each other, and time that they touch walls [s]."""
    if meter is None:
        return {"contacts": -1, "obstacle_contact_s": -1.0}
    return {"contacts": int(meter.episodes), "obstacle_contact_s": float(meter.obstacles)}
