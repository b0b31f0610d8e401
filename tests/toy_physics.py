"""A study of two robots and a ball in contact physics that can blow up, or raise half-way."""

import numpy as np

from mjmr.claims import Bound, Claim, Evidence
from mjmr.conditions import Grid, Parameter
from mjmr.kinematics import KinematicSimulation
from mjmr.robots.soccer_bot import SoccerBot
from mjmr.sensors.localizer import Localizer
from mjmr.simulation import Simulation
from mjmr.study import Size, Study
from mjmr.world import World

ACTS = ("well", "explode", "explode-at-once", "raise", "nothing", "two")


def unstable(spec):
    """Hinges that push the way they turn: the robots spin up until the physics diverges."""
    for joint in spec.joints:
        if joint.name.endswith("yaw"):
            joint.damping = [-1.5, 0.0, 0.0]


def world(act="well"):
    built = World.rectangle(3.0, 2.0, border=0.2)
    robots = built.add_group(SoccerBot, [[-1.0, 0.3, 0.0], [1.0, -0.3, np.pi]])
    # faster than the control rate: some samples are superseded before anybody can read them
    robots.mount(Localizer(rate=100.0, latency=0.02, position_noise=0.002, yaw_noise=0.01))
    built.add_golf_ball(-0.6, 0.3)
    if act == "explode":
        built.edit(unstable)
    return built, robots


def trial(condition, seed):
    act = condition["act"]
    if act == "nothing":
        return {"x": 0.0}
    kind = KinematicSimulation if condition["mode"] == "metric" else Simulation
    built, robots = world(act)
    simulation = kind(built, seed=seed)
    if act == "two":
        kind(world()[0], seed=seed)
    for t in simulation.ticks(condition["duration"]):
        report = robots.localizer.read()
        simulation.note(goals=[[1.0, 0.3], [-1.0, -0.3]])
        robots.drive(np.column_stack([[0.6, 0.6], -0.5 * np.nan_to_num(report[:, :2])]))
        if act == "raise" and t > 0.5:
            raise RuntimeError("the controller gave up")
        if act == "explode-at-once":
            simulation.data.qvel[:] = 1e12
    poses = simulation.truth.poses(robots)
    return {"x": float(poses[0, 0]), "y": float(poses[1, 1]), "yaw": float(poses[0, 2])}


def prepare():
    """Builds and ticks a simulation, as one does to have things compiled."""
    for _ in Simulation(world()[0]).ticks(0.05):
        pass


def claims():
    return [
        Claim(
            id="inside",
            text="They stay inside.",
            how="largest |x|",
            bound=Bound("<", 2.0),
            evaluate=lambda t: Evidence(float(np.abs(t.values("x")).max())),
            sizes=("quick",),
        )
    ]


def _study(name, *grids):
    return Study(
        name=name,
        title="Two robots",
        paper="none",
        summary="Two robots pass each other.",
        parameters=(
            Parameter("act", "How the trial behaves", "well", values=ACTS),
            Parameter("mode", "Simulation", "physical", values=("metric", "physical")),
            Parameter("duration", "Simulated", 1.5, unit="s"),
        ),
        sizes=(Size("quick", grids, 1, 0.1),),
        trial="tests.toy_physics:trial",
        claims="tests.toy_physics:claims",
        prepare="tests.toy_physics:prepare",
        source_packages=(),
    )


study = _study("toy-physics", Grid(seeds=2), Grid(mode="metric"))
exploding = _study("toy-exploding", Grid(), Grid(act="explode", duration=60.0))
