"""A study with a part to swap: robots in the kinematic simulation, moved by a `mover`."""

import numpy as np

from mjmr.claims import Bound, Claim, Evidence
from mjmr.conditions import Grid, Parameter
from mjmr.kinematics import KinematicSimulation
from mjmr.parts import Method, Part
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.study import Size, Study
from mjmr.world import World

TICKS = 20
PERIOD = 0.1


class Slow:
    """The published mover: half the given speed, along a direction drawn once."""

    def __init__(self, n, speed, rng):
        angle = rng.uniform(-np.pi, np.pi, n)
        self.velocity = 0.5 * speed * np.column_stack([np.cos(angle), np.sin(angle)])

    def step(self, position):
        return self.velocity


class Full(Slow):
    """The whole speed."""

    def __init__(self, n, speed, rng):
        super().__init__(n, 2 * speed, rng)


def trial(condition, seed, parts):
    world = World.rectangle(10.0, 10.0)
    poses = np.zeros((4, 3))
    poses[:, 0] = np.arange(4) - 1.5
    robots = world.add_group(SoccerBot, poses)
    simulation = KinematicSimulation(world, seed=seed, control_period=PERIOD)
    mover = parts["mover"](robots.n, condition["speed"], simulation.rng("mover"))
    position = poses[:, :2].copy()
    for _ in simulation.ticks(TICKS * PERIOD):
        velocity = mover.step(position)
        position = position + PERIOD * velocity
        robots.drive(np.column_stack([velocity, np.zeros(robots.n)]))
    assert (poses[:, 1] == 0.0).all()
    return {
        "way": float(np.linalg.norm(position - poses[:, :2], axis=1).mean()),
        "drift": float(position[:, 0].mean()),
        "far": bool(np.abs(position).max() > 1.6),
        "undefined": float("nan"),
        "name": type(mover).__name__,
        **({"slow_only": 1.0} if condition["speed"] < 0.5 else {}),
        "wall_step_us": 1.0 + seed,
    }


def claims():
    return [
        Claim(
            id="slow",
            text="They are slow.",
            how="mean way",
            bound=Bound("<", 0.5),
            evaluate=lambda t: Evidence(float(t.where(speed=0.4).values("way").mean())),
            sizes=("quick",),
        ),
        Claim(
            id="anything",
            text="They are somewhere.",
            how="mean way",
            bound=Bound(">=", 0.0),
            evaluate=lambda t: Evidence(float(t.values("way").mean())),
            sizes=("quick",),
        ),
    ]


def film(study, path, options):
    metrics = study.bound_trial()(study.condition(), 0)
    path.write_text(metrics["name"])


study = Study(
    name="toy-parts",
    title="Movers",
    paper="none",
    summary="Moves robots.",
    parameters=(
        Parameter("speed", "of the robots", 0.4, unit="m/s"),
        Parameter("mode", "simulation", "metric", ("metric",)),
    ),
    sizes=(
        Size("quick", (Grid(speed=(0.4, 0.8)),), 8, 0.1),
        Size("standard", (Grid(speed=(0.4, 0.8)),), 10, 0.1),
    ),
    trial="tests.toy_parts:trial",
    claims="tests.toy_parts:claims",
    film="tests.toy_parts:film",
    parts=(
        Part(
            role="mover",
            doc="velocities from positions",
            default="tests.toy_parts:Slow",
            constructor=("n", "speed", "rng"),
            methods=(
                Method(
                    name="step", arguments=("position",), returns=("n", 2), unit="m/s, world frame"
                ),
            ),
            optional=("nothing: for nobody",),
        ),
    ),
    source_packages=(),
)
