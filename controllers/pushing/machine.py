"""The one state machine of all three tasks: wander, position, push; c, p and b are all it takes."""

from dataclasses import dataclass

from controllers.pushing.cues import InPosition
from controllers.schemas import Avoid, Draw, MoveTo, Noise, Sees, StateMachine, Swirl
from mjmr.errors import InvalidInputError

_REACH = 1.5  # m: teammates and targets count up to here
_NEAR = 0.42  # m: whatever the obstacle ring feels, walls above all, counts up to here
_HOLD = 5.0  # s, of a random heading
_CLEAR = 0.1  # m off the hull: where obstacles have full strength, positioning robots stand off
_TOUCH = 0.05  # m off the hull: positioning robots back off at full strength
_DRAW = 3.0  # m from home: where the draw to it has its full strength


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """All that differs between tasks.

    Attributes:
        c: Cooperation, 0 to 1.
        p: Position: allowed lateral offset in robot radii.
        b: Build flag: whether home's polarity is reversed.
    """

    c: float
    p: float
    b: bool = False

    def __post_init__(self):
        if not 0 <= self.c <= 1:
            raise InvalidInputError(f"cooperation c is a share, 0 to 1; got {self.c}")
        if not 0 <= self.p < 100:
            raise InvalidInputError(f"position p counts robot radii, 0 or more; got {self.p}")


def pusher_machine(
    parameters: Parameters, *, radius: float = 0.24, share: str = ""
) -> StateMachine:
    """The controller of Cherry and Zhang, sections 2.1 to 2.3.

    It perceives ``target`` (the nearest disc that is not where it shall be), ``home``,
    ``teammates`` (robots the camera sees) and ``obstacles`` (the nearest points that the ring
    feels). Weights and ramps, which the paper does not give, are ours.

    Args:
        parameters: c, p and b.
        radius: Of the robots [m].
        share: Name of a percept that replaces p robot by robot; see :class:`InPosition`.
    """
    c, p, build = parameters.c, parameters.p, parameters.b
    clear = radius + _CLEAR
    noise = Noise(hold=_HOLD)
    away = not build
    avoid = Avoid("teammates", reach=_REACH, stop=clear) + Avoid(
        "obstacles", reach=_NEAR, stop=clear
    )
    to_noise = Swirl("teammates", towards=noise, reach=_REACH, stop=clear) + Swirl(
        "obstacles", towards=noise, reach=_NEAR, stop=clear
    )
    # these go round robots, as the paper says: round walls they would lead away from the disc
    to_home = Swirl("teammates", towards="home", away=away, reach=_REACH, stop=clear)
    to_target = Swirl("teammates", towards="target", reach=_REACH, stop=clear)

    def round_target(saturation: float) -> Swirl:
        return Swirl(
            "target", towards="home", away=away, reach=_REACH, stop=clear,
            saturation=saturation,
        )  # fmt: skip

    wander = 0.6 * noise + avoid + to_noise
    if build:
        wander = wander + Draw("home", full=_DRAW)
    position = (
        2.0 * (1.0 - c) * (avoid + to_noise + to_home)
        + 0.2 * noise
        + 1.0 * round_target(0.2)
        + 0.6 * MoveTo("target", dead_zone=clear, slow=0.1, repel=clear, touch=radius + _TOUCH)
    )
    push = (
        c * (avoid + to_noise + to_target)
        + 0.2 * noise
        + 0.4 * round_target(1.0)
        + 1.0 * MoveTo("target")
    )
    return StateMachine(
        states={"wander": wander, "position": position, "push": push},
        cues={
            "sees a target": Sees("target"),
            "in position": InPosition(p, radius=radius, build=build, share=share),
        },
        transitions=[
            ("wander", "sees a target", "position"),
            ("position", "not sees a target", "wander"),
            ("position", "in position", "push"),
            ("push", "not sees a target", "wander"),
            ("push", "not in position", "position"),
        ],
    )
