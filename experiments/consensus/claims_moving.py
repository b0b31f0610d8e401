"""Claims, all ours: formations that move, and an average by radio. The paper has neither."""

import math
from typing import Any

import numpy as np

from experiments.consensus.claims_physical import claim
from experiments.consensus.evidence import largest, total
from mjmr.claims import Bound, Claim, Evidence
from mjmr.table import Table

MOVING: dict[str, Any] = {
    "mode": "physical", "experiment": "moving", "schedule": "case-i", "calibrated": True,
    "noise": 0.0,
}  # fmt: skip
PLAIN: dict[str, Any] = {**MOVING, "loss": 0.0, "delay": 0.0}
LAW: dict[str, Any] = {**PLAIN, "feedforward": "none"}
TOLD: dict[str, Any] = {**PLAIN, "feedforward": "told"}
LATE = {**MOVING, "loss": 0.0, "delay": 0.5}
AVERAGE: dict[str, Any] = {"mode": "physical", "experiment": "average", "delay": 0.0}
TRACKS = "beyond the paper: moving formation tracking"
MEAN = "beyond the paper: average consensus by radio"


def claims() -> list[Claim]:
    """Every claim of this module."""
    return [*_moving(), *_directed(), *_average()]


def _moving() -> list[Claim]:
    off, rms = largest("lag_off"), largest("formation_rms_m")
    return [
        claim("moving-line-lag", "leader at 0.2 m/s on a line, the paper's law alone, followers' "
              "weights 0.2 and 0.8: each follower's lag less 2 V / g a link of the chain, a share, "
              "largest", Bound("<=", 0.03), {**LAW, "path": "line"}, off, "", TRACKS),
        claim("moving-circle-lag", "leader at 0.2 m/s on a circle of 2 m, the same: error less "
              "the closed loop's, a share, largest", Bound("<=", 0.03), {**LAW, "path": "circle"},
              off, "", TRACKS),
        claim("moving-turn-lag", "formation that turns 0.1 rad/s about the leader's output, the "
              "same", Bound("<=", 0.05), {**LAW, "path": "rotate"}, off, "", TRACKS),
        claim("moving-swing-lag", "formation whose size swings 30 %, the same",
              Bound("<=", 0.05), {**LAW, "path": "scale"}, off, "", TRACKS),
        claim("moving-told", "velocity and acceleration told by radio, all four paths: followers' "
              "rms error over the last turn, largest", Bound("<=", 0.05), TOLD, rms, "m", TRACKS),
        claim("moving-told-share", "the same, mean over that of the paper's law alone",
              Bound("<=", 0.05), PLAIN, _told_share, "", TRACKS),
        claim("moving-leader", "rms error of the leader, who knows the path, largest",
              Bound("<=", 0.02), PLAIN, largest("leader_rms_m"), "m", TRACKS),
        claim("moving-told-loss", "told, half of all messages lost, line and circle: followers' "
              "rms error, largest", Bound("<=", 0.05),
              {**MOVING, "feedforward": "told", "loss": 0.5, "delay": 0.0}, rms, "m", TRACKS),
        claim("moving-late-lag", "messages 0.5 s late, line and circle, told and not: error less "
              "the closed loop's, V tau a link where told, a share, largest", Bound("<=", 0.08),
              LATE, off, "", TRACKS),
        claim("moving-contacts", "contacts of two robots, all runs of moving formations, side "
              "4 m, sum", Bound("<=", 0.0), {"mode": "physical", "experiment": "moving"},
              total("contacts"), "", TRACKS),
    ]  # fmt: skip


def _directed() -> list[Claim]:
    """What sizes alone do not tell: that followers are behind, and how far in phase."""
    how = (
        "written later, seed 1000 seen: as {}, difference of the errors' constant parts (line) or "
        "swings from the closed loop's, direction and phase included, a share, largest; on a line "
        "a link adds V / 50"
    )
    told = {
        "line": ("line", 0.03), "circle": ("circle", 0.03), "turn": ("rotate", 0.05),
        "swing": ("scale", 0.05),
    }  # fmt: skip
    return [
        claim(f"moving-{name}-directed", how.format(f"moving-{name}-lag"), Bound("<=", bound),
              {**LAW, "path": path}, largest("swing_off"), "", TRACKS)
        for name, (path, bound) in told.items()
    ]  # fmt: skip


def _average() -> list[Claim]:
    metropolis, ratio = {**AVERAGE, "rule": "metropolis"}, {**AVERAGE, "rule": "ratio"}
    error = largest("average_error")
    return [
        claim("average-stands", "8 robots that stand, Metropolis weights, no loss, 60 s: estimate "
              "less the readings' mean, in deviations of a reading, largest", Bound("<=", 0.01),
              {**metropolis, "patrol": False, "loss": 0.0}, error, "", MEAN),
        claim("average-patrols", "8 robots that patrol, Metropolis weights, no loss, 160 s: the "
              "same", Bound("<=", 0.05), {**metropolis, "patrol": True, "loss": 0.0}, error, "",
              MEAN),
        claim("average-kept", "the same runs: mean of the estimates less the readings' mean, "
              "largest size: no graph moves it", Bound("<=", 1e-9),
              {**metropolis, "patrol": True, "loss": 0.0}, _bias_most, "", MEAN),
        claim("average-loss-agrees", "standing, half of all messages lost, Metropolis weights: "
              "difference of two estimates, largest", Bound("<=", 0.01),
              {**metropolis, "patrol": False, "loss": 0.5}, largest("disagreement"), "", MEAN),
        claim("average-loss-biased", "the same runs agree, and not on the mean: root of the mean "
              "squared bias", Bound(">=", 0.05), {**metropolis, "patrol": False, "loss": 0.5},
              _bias_rms, "", MEAN),
        claim("average-ratio", "standing, half of all messages lost, ratio consensus: estimate "
              "less the readings' mean, largest", Bound("<=", 0.01),
              {**ratio, "patrol": False, "loss": 0.5}, error, "", MEAN),
        claim("average-ratio-patrols", "patrolling, half of all messages lost, ratio consensus: "
              "root of the mean squared bias", Bound("<=", 0.05),
              {**ratio, "patrol": True, "loss": 0.5}, _bias_rms, "", MEAN),
        claim("average-patrols-biased", "patrolling, half of all messages lost, Metropolis "
              "weights: the same", Bound(">=", 0.05), {**metropolis, "patrol": True, "loss": 0.5},
              _bias_rms, "", MEAN),
        claim("average-contacts", "contacts of two robots, all runs of averages, sum",
              Bound("<=", 0.0), AVERAGE, total("contacts"), "", MEAN),
    ]  # fmt: skip


def _told_share(table: Table) -> Evidence:
    from mjmr import statistics

    told = table.where(feedforward="told").values("formation_rms_m")
    alone = table.where(feedforward="none").values("formation_rms_m")
    return Evidence.of(statistics.ratio_of_means(told, alone))


def _bias_most(table: Table) -> Evidence:
    values = np.asarray(table.values("average_bias"), dtype=np.float64)
    return Evidence(float(np.abs(values).max()), n=len(values))


def _bias_rms(table: Table) -> Evidence:
    """Root mean square of the biases, interval by that of the mean of the squares."""
    from mjmr import statistics

    squares = np.asarray(table.values("average_bias"), dtype=np.float64) ** 2
    found = statistics.mean(squares)
    interval = math.sqrt(max(found.low, 0.0)), math.sqrt(found.high)
    return Evidence(math.sqrt(found.value), interval, len(squares))
