"""Plots: what a bound or a table alone would hide."""

from pathlib import Path

import numpy as np

from mjmr.plot import figure, interval_line
from mjmr.statistics import Estimate
from mjmr.table import Table


def plots(table: Table, folder: Path) -> list[Path]:
    """Write every plot the table has trials for; returns the files."""
    written = []
    turns = table.where(platform="koala", test="turn")
    if len(turns.distinct("turn")) > 2:
        written.append(_scrub(turns, folder))
    kicks = table.where(platform="aibo_ers7", test="kick")
    if kicks.finished > 20:
        written.append(_kicks(kicks, folder))
    circles = table.where(platform="tamiya_txt1", test="circle")
    if len(circles.distinct("angle_deg")) > 2:
        written.append(_circles(circles, folder))
    return written


def _scrub(rows: Table, folder: Path) -> Path:
    path = folder / "koala-scrub.svg"
    title = "Koala: how much further the wheels turn than the robot"
    with figure(path, title, "yaw rate [rad/s]", "turn by encoders / true turn") as axes:
        for dt, at in rows.split("dt_ms"):
            rates = sorted(float(v) for v in at.distinct("turn"))
            values = [float(at.where(turn=rate).values("scrub").mean()) for rate in rates]
            axes.plot(rates, values, "o-", label=f"{dt:g} ms")
        axes.axhspan(1.05, 1.25, alpha=0.08)
        axes.axhline(1.12, linestyle=":", label="published 1.12")
        axes.legend()
    return path


def _kicks(rows: Table, folder: Path) -> Path:
    path = folder / "aibo-kicks.svg"
    title = f"AIBO: where the ball came to rest, {rows.finished} kicks"
    with figure(path, title, "ahead [m]", "to the left [m]") as axes:
        for variant, at in rows.split("variant"):
            way, angle = at.values("distance_m"), np.radians(at.values("angle_deg"))
            axes.plot(way * np.cos(angle), way * np.sin(angle), ".", label=str(variant))
        axes.plot([0], [0], "k+")
        axes.set_aspect("equal")
        axes.legend()
    return path


def _circles(rows: Table, folder: Path) -> Path:
    path = folder / "txt1-circles.svg"
    title = "TXT-1: radius against the bicycle model"
    with figure(path, title, "steering [deg]", "error of the radius [%]") as axes:
        for speed, at in rows.split("speed"):
            points, estimates = [], []
            for angle, there in at.split("angle_deg"):
                if float(angle) < 0:  # to the right: one angle, a line across zero would mislead
                    continue
                values = there.values("error_pct")
                middle = float(values.mean())
                points.append(float(angle))
                low, high = float(values.min()), float(values.max())
                estimates.append(Estimate(middle, low, high, len(values)))
            interval_line(axes, points, estimates, f"{speed:g} m/s, range over timesteps")
        axes.axhspan(-2, 2, alpha=0.08)
        axes.legend()
    return path
