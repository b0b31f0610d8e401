"""How well an overhead camera sees the robots: poses and identities from single rendered images.

The paper's robots were seen by such a camera; its accuracy there is not stated. Here calibration is
exact and images have no blur, distortion or shadows, so the errors are a lower bound: what remains
is the pixels' size, noise, light, perspective and what boxes hide.
"""

import time
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from controllers.perception import PatternFinder
from experiments.safe_navigation.scenes import scene
from mjmr.geometry import wrap_angle
from mjmr.kinematics import KinematicSimulation
from mjmr.randomness import Streams
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.sensors.camera import Camera
from mjmr.world import World

Array = NDArray[np.float64]
ROBOTS = 10
WIDTH, HEIGHT = 800, 600  # px
CAMERA_HEIGHT = 4.0  # m, above the middle of the field
FOVY = np.radians(61.0)  # just sees all of the floor inside the walls in a 4:3 image
_TOUCHING = 0.3  # share of the robots that touch another one
_GAP = 0.0005  # m between two that touch


def overhead_camera(
    world: World,
    *,
    width: int = WIDTH,
    height: int = HEIGHT,
    rate: float = 60.0,
    latency: float = 0.0,
    noise: float = 5.0,
    spoilt: bool = True,
) -> Camera:
    """Stand the camera over the field.

    Args:
        world: The field.
        width: [px].
        height: [px].
        rate: [Hz].
        latency: [s].
        noise: Standard deviation [grey levels].
        spoilt: Whether the corners are 30 % darker than the middle and the right edge 20 % darker
            than the left.
    """
    camera = Camera(
        width=width,
        height=height,
        fovy=float(FOVY),
        rate=rate,
        latency=latency,
        noise=noise,
        vignetting=0.3 if spoilt else 0.0,
        unevenness=0.2 if spoilt else 0.0,
    )
    return world.add_camera(
        camera, position=(0, 0, CAMERA_HEIGHT), look_at=(0, 0, 0), name="overhead"
    )


def pattern_finder(world: World, camera: Camera) -> PatternFinder:
    """Finder of every robot of a world of SoccerBots, rows in the team's order."""
    robots = [(g.team, g.first_number + i) for g in world.groups for i in range(g.n)]
    return PatternFinder(camera.calibration, SoccerBot.pattern, robots)


def vision_accuracy(
    frames: int,
    seed: int,
    *,
    width: int = WIDTH,
    height: int = HEIGHT,
    noise: float = 5.0,
    lighting: str = "uneven",
    teams: Sequence[str] = ("yellow", "blue"),
) -> dict[str, float | int]:
    """Errors of the vision over images of ten robots at random poses all over the floor.

    Every second image has the boxes of scene A. Three in ten robots touch another one, and any may
    touch a wall or a box.

    Args:
        frames: Number of images.
        seed: Of poses and noise.
        width: Of the image [px].
        height: Of the image [px].
        noise: Standard deviation [grey levels].
        lighting: ``"uneven"``: a lamp in a corner and a camera whose image is darker towards the
            edges; ``"even"``: neither.
        teams: Colours; ten robots are shared out equally.

    Returns:
        Metrics: errors in mm and degrees over the robots found, numbers of robots shown, lost
        (missed or mistaken) and mistaken for another, and wall times of an image [ms], medians.
    """
    setups = [_setup(boxes, seed, width, height, noise, lighting, teams) for boxes in ("", "A")]
    draw = Streams(seed).generator("poses")
    errors, render, find = np.empty((frames, ROBOTS, 3)), np.empty(frames), np.empty(frames)
    for k in range(frames):
        world, camera, finder = setups[k % 2]
        poses = random_poses(world, draw)
        start = time.perf_counter()
        # what the camera's sample number k would be of a world in this state
        image = camera.compute((0.0, poses), k)
        seen = time.perf_counter()
        errors[k] = finder.find(image) - poses
        render[k], find[k] = seen - start, time.perf_counter() - seen
    for world, _, _ in setups:
        world.simulation.close()
    off = np.hypot(errors[..., 0], errors[..., 1])
    missed = np.isnan(off)
    wrong = ~missed & (off > SoccerBot.radius)
    right = ~missed & ~wrong
    turn = np.degrees(np.abs(wrap_angle(errors[..., 2][right])))
    return {
        "position_rms_mm": 1e3 * float(np.sqrt((off[right] ** 2).mean())),
        "position_max_mm": 1e3 * float(off[right].max()),
        "heading_rms_deg": float(np.sqrt((turn**2).mean())),
        "heading_max_deg": float(turn.max()),
        "robots_shown": off.size,
        "robots_lost": int((missed | wrong).sum()),
        "robots_mistaken": int(wrong.sum()),
        "wall_render_ms": 1e3 * float(np.median(render)),
        "wall_find_ms": 1e3 * float(np.median(find)),
    }


def _setup(
    boxes: str,
    seed: int,
    width: int,
    height: int,
    noise: float,
    lighting: str,
    teams: Sequence[str],
) -> tuple[World, Camera, PatternFinder]:
    world = World.rectangle(4.9, 3.8, border=0.30, lighting=lighting)
    for x, y, length, breadth in scene(boxes).boxes if boxes else ():
        world.add_box(x, y, length, breadth)
    each = ROBOTS // len(teams)
    for t, team in enumerate(teams):
        starts = [[-2.0 + 0.3 * i, 1.8 - 0.3 * t, 0.0] for i in range(each)]
        world.add_group(SoccerBot, starts, team=team, name=team)
    camera = overhead_camera(
        world, width=width, height=height, noise=noise, spoilt=lighting == "uneven"
    )
    # it moves nothing here: it has the camera's schedule and streams
    KinematicSimulation(world, seed=seed)
    return world, camera, pattern_finder(world, camera)


def random_poses(world: World, draw: np.random.Generator) -> Array:
    """Poses (ROBOTS, 3) that overlap nothing, some touching each other."""
    radius = SoccerBot.radius
    low, high = world.bounds[:2] + radius, world.bounds[2:] - radius
    boxes = world.boxes
    placed = np.empty((0, 2))
    while len(placed) < ROBOTS:
        if len(placed) and draw.random() < _TOUCHING:
            angle = draw.uniform(-np.pi, np.pi)
            side = np.array([np.cos(angle), np.sin(angle)]) * (2 * radius + _GAP)
            spot = placed[draw.integers(len(placed))] + side
        else:
            spot = draw.uniform(low, high)
        beyond = np.maximum(np.abs(spot - boxes[:, :2]) - boxes[:, 3:], 0.0)
        free = (
            (np.hypot(*beyond.T) >= radius).all() and (spot >= low).all() and (spot <= high).all()
        )
        if free and (np.hypot(*(placed - spot).T) >= 2 * radius).all():
            placed = np.vstack([placed, spot])
    return np.column_stack([placed, draw.uniform(-np.pi, np.pi, ROBOTS)])
