"""The conditions that claims are narrowed to, by name."""

from experiments.perimeter.sizes import LATER

PLAIN = {
    "mode": "physical", "sensing": "rays", "obstacles": "fan", "localization": "localizer",
    "robots": 5, "edge": "disc", "d_com": 25.0,
    "spacing": "repaired", "factor": 0.0, "estimated": False, "gain": "soft", "failure": "none",
    "wrong": 0.0,
}  # fmt: skip
JOIN = {**PLAIN, "task": "join", "radius": 10.0, "growth": 0.0}
STAY = {**PLAIN, "task": "stay", "start": "bunch", "radius": 10.0, "growth": 0.0,
        "duration": 600.0}  # fmt: skip
N1 = {**PLAIN, "task": "stay", "start": "even", "estimated": True, "duration": LATER}
LITERAL = {**STAY, "spacing": "literal"}
DRIVEN = {"task": "envelope", "mode": "physical"}
