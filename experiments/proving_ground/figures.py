"""Writes the figures that ``mjmr robots`` shows, from the results of a run.

``python -m experiments.proving_ground.figures renders/proving-ground/standard``
"""

import json
import sys
from pathlib import Path

from mjmr.errors import InvalidInputError, one_line

TARGET = Path(__file__).with_name("figures.json")
# what is shown of each platform: claim and words
SHOWN = {
    "pioneer2dx": {
        "pioneer-straight": "5 m straight, error",
        "pioneer-turn": "360 degrees in place, error",
        "pioneer-circle-end": "1 m circle, end off",
        "pioneer-stop-tilt": "tilt in a stop from 1.6 m/s",
        "pioneer-crowd-tilt": "tilt in a crowd of 50",
    },
    "koala": {
        "koala-scrub": "turn by encoders / true turn",
        "koala-straight": "5 m straight, sideways",
        "koala-odometry-even-elsewhere": "odometry, 5 turns, any speed",
        "koala-odometry-elsewhere": "the same, uneven grip",
        "koala-square": "2 m square, dead reckoning off",
    },
    "tamiya_txt1": {
        "txt1-circle": "radius against the bicycle model",
        "txt1-turn-bound-open": "largest yaw rate at 0.3 rad/s",
        "txt1-roll-over-driven": "drives at full lock until it rolls over",
    },
    "aibo_ers7": {
        "aibo-walk-forward": "forwards",
        "aibo-walk-backward": "backwards",
        "aibo-walk-left": "sideways",
        "aibo-walk-turn-left": "turning",
        "aibo-up-from-back": "gets up from its back in 6 s",
        "aibo-kick-forward-mean": "kicks forwards, mean",
        "aibo-kick-left-mean": "heads sideways, mean",
    },
    "round_pusher": {
        "round_pusher-straight": "5 m straight, error",
        "round_pusher-turn": "360 degrees in place, error",
        "round_pusher-push": "push against a wall / stated - 1",
        "round_pusher-stop-tilt": "tilt in reversing from 0.5 m/s",
        "round_pusher-aim": "turret off its aim after half a second",
    },
    "nims": {
        "nims-arrival": "off its goal on arrival",
        "nims-residual-swing": "swing left over",
        "nims-period": "period against a pendulum's",
        "nims-tension": "tension against statics",
    },
    "soccer_bot": {
        "soccer_bot-acceleration": "acceleration, error",
        "soccer_bot-braking": "braking, error",
    },
    "tj_pro": {
        "tj_pro-straight": "3 m straight, error",
        "tj_pro-turn": "18 turns of 20 degrees, error",
        "tj_pro-arc": "arc of unequal servos, heading off",
        "tj_pro-slip": "push on a wall, tyres slipping",
    },
    "four_wheeler": {
        "four_wheeler-straight": "5 m straight, error",
        "four_wheeler-turn": "three turns in place, error",
        "four_wheeler-scrub": "turn by encoders / true turn",
        "four_wheeler-stop-tilt": "tilt in reversing from 1 m/s",
    },
}


def figures(claims: list[dict]) -> dict[str, dict[str, str]]:
    """Text of every figure of :data:`SHOWN`, from the claims of a run.

    Raises:
        InvalidInputError: A claim was not measured.
    """
    by_id = {claim["id"]: claim for claim in claims}
    found: dict[str, dict[str, str]] = {}
    for platform, shown in SHOWN.items():
        found[platform] = {}
        for claim_id, words in shown.items():
            claim = by_id.get(claim_id, {})
            if claim.get("measured") is None:
                raise InvalidInputError(f"{claim_id} was not measured in this run")
            value = claim["measured"]
            text = f"{value:.1e}" if 0 < abs(value) < 1e-3 else f"{value:.3g}"
            found[platform][words] = f"{text} {claim['unit']}".strip()
    return found


def main(arguments: list[str]) -> int:
    """Read ``claims.json`` of a results folder, write ``figures.json`` beside this file."""
    if len(arguments) != 1:
        print("usage: python -m experiments.proving_ground.figures FOLDER", file=sys.stderr)
        return 2
    try:
        claims = json.loads((Path(arguments[0]) / "claims.json").read_text())
        told = figures(claims)
    except (OSError, ValueError) as e:
        print(f"no figures from {arguments[0]}: {one_line(e)}", file=sys.stderr)
        return 2
    TARGET.write_text(json.dumps(told, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
