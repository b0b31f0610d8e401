"""Rays against rendered cameras: do both see the same teammates, in the same places?"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from experiments.consensus.arena import EYE, HAND, RANGE, Eyes
from experiments.consensus.physical import Metrics, Team
from experiments.consensus.roles import PUBLISHED
from mjmr.geometry import wrap_angle


class AgreementTeam(Team):
    """Robots that agree by rays and carry cameras besides."""

    def __init__(
        self, condition: Mapping[str, Any], seed: int, parts: Mapping[str, Any] = PUBLISHED
    ):
        """See :class:`experiments.consensus.physical.Team`."""
        super().__init__({**condition, "sight": "rays"}, seed, parts, cameras=True)


def measure(team: AgreementTeam) -> Metrics:
    """Robots agree by rays while cameras look at the same instants.

    Returns:
        ``looks`` of pairs, ``same`` share on which both say the same, ``camera_only`` and
        ``rays_only`` counts; of those both saw ``bearing_rms_deg`` and ``distance_rms`` (share);
        ``inside_same``, the share without pairs within 2 degrees of the cone's edge or 0.2 m of
        the range.
    """
    condition = team.condition
    eyes: Eyes = team.cameras
    cone = np.radians(condition["cone_deg"])
    by_rays, by_camera = [], []
    last = -1.0
    for time in team.simulation.ticks(condition["duration"]):
        team.tick(time)
        if eyes.sampled_at > last:
            last = eyes.sampled_at
            by_rays.append(team.eyes.read())
            by_camera.append(eyes.read())
    rays, camera = np.array(by_rays), np.array(by_camera)
    pairs = np.broadcast_to(~np.eye(team.n, dtype=bool), rays.shape[:3])
    ray, cam = np.isfinite(rays[..., 0]), np.isfinite(camera[..., 0])
    both = ray & cam
    bearing = wrap_angle(camera[..., 1] - rays[..., 1])[both]
    distance = (camera[..., 0] / rays[..., 0] - 1.0)[both]
    # an edge is told from whichever of the two saw it
    seen = np.where(ray[..., None], rays, camera)
    x = seen[..., 0] * np.cos(seen[..., 1]) - EYE[0]
    y = seen[..., 0] * np.sin(seen[..., 1])
    edge = np.abs(np.abs(np.arctan2(y, x)) - cone / 2) < np.radians(2.0)
    edge |= np.abs(np.hypot(x, y) - RANGE) < HAND
    inside = pairs & ~((ray | cam) & edge)
    same = ray == cam
    return {
        "looks": int(pairs.sum()),
        "seen": int(both.sum()),
        "same": float(same[pairs].mean()),
        "inside_same": float(same[inside].mean()),
        "camera_only": int((cam & ~ray).sum()),
        "rays_only": int((ray & ~cam).sum()),
        "bearing_rms_deg": float(np.degrees(np.sqrt((bearing**2).mean()))),
        "distance_rms": float(np.sqrt((distance**2).mean())),
    }
