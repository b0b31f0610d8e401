"""How much each size runs: the same tests, with other numbers of seeds."""

from typing import Any

from mjmr.conditions import Grid
from mjmr.study import Size

_DT = (2.0, 5.0)
_AIBO: dict[str, Any] = {"platform": "aibo_ers7", "friction": (0.6, 1.0), "dt_ms": (2.0, 4.0)}
_ROBOTS = (
    "pioneer2dx", "koala", "aibo_ers7", "tamiya_txt1", "nims", "round_pusher", "soccer_bot",
    "tj_pro", "four_wheeler",
)  # fmt: skip
_FOUR: dict[str, Any] = {"platform": "four_wheeler", "test": ("straight", "turn", "stop")}
_TJ_PRO: dict[str, Any] = {"platform": "tj_pro", "test": ("straight", "turn", "circle", "stop")}
_PUSHER: dict[str, Any] = {
    "platform": "round_pusher",
    "test": ("straight", "turn", "push", "stop", "aim"),
}
_NIMS = ("lab-curve", "lab-tendon", "field-curve", "field-tendon")


def _wheels(dt: tuple[float, ...], turns: tuple[float, ...], speeds: tuple[float, ...]) -> list:
    tests = ("straight", "turn", "circle", "stop")
    return [
        Grid(platform="pioneer2dx", test=tests, dt_ms=dt, seeds=1),
        Grid(platform="soccer_bot", test="dash", variant=("planar", "omni"), dt_ms=dt, seeds=1),
        Grid(platform="koala", test="turn", turn=turns, dt_ms=dt, seeds=1),
        Grid(platform="koala", test="odometry-even", turn=1.0, seeds=1),
        Grid(platform="koala", test="square", variant=("left", "right"), speed=speeds, seeds=1),
        Grid(
            platform="tamiya_txt1",
            test="circle",
            angle_deg=(10.0, 20.0, 28.0, -28.0) if len(dt) > 1 else (20.0, -28.0),
            speed=(0.5, 1.0, 2.0) if len(dt) > 1 else (1.0, 2.0),
            dt_ms=dt,
            seeds=1,
        ),
        Grid(
            platform="tamiya_txt1",
            test=("unicycle", "unicycle-open"),
            variant=("plain", "changing"),
            dt_ms=dt,
            seeds=1,
        ),
    ]


def _large(seeds: int, worlds: int) -> tuple[Grid, ...]:
    crowd = {"test": "crowd", "variant": ("forward", "reverse"), "dt_ms": (5.0, 10.0)}
    return (
        *_wheels(_DT, (0.3, 0.5, 0.8, 1.0, 2.0), (0.2, 0.4)),
        Grid(platform="pioneer2dx", **crowd, seeds=worlds),
        Grid(platform="koala", test="straight", dt_ms=_DT, seeds=8),
        *(
            Grid(platform="koala", test=test, turn=(0.4, 0.8, 1.6, 2.0), seeds=n)
            for test, n in (("odometry", seeds), ("odometry-even", 1))
        ),
        *(
            Grid(platform="koala", test=test, turn=(0.4, 1.0, 2.0), friction=(0.5, 1.1), seeds=n)
            for test, n in (("odometry", seeds), ("odometry-even", 1))
        ),
        Grid(platform="tamiya_txt1", test=("roll-over", "roll-over-steps"), dt_ms=_DT, seeds=1),
        Grid(
            platform="nims",
            test="move",
            variant=_NIMS,
            speed=(0.1, 1.0),
            dt_ms=(2.0, 10.0),
            seeds=1,
        ),
        Grid(platform="nims", test=("pendulum", "tension"), variant=_NIMS, dt_ms=10.0, seeds=1),
        Grid(
            **_AIBO,
            test="walk",
            variant=("forward", "slow", "backward", "left", "right", "turn-left", "turn-right"),
            seeds=1,
        ),
        Grid(**_AIBO, test="straight", seeds=5),
        Grid(**_AIBO, test="get-up", variant=("front", "left", "right", "back"), seeds=seeds),
        Grid(**_AIBO, test="kick", variant=("forward", "left", "right"), seeds=seeds),
        Grid(platform="aibo_ers7", test="roll", dt_ms=(2.0, 4.0), seeds=1),
        Grid(**_TJ_PRO, dt_ms=(5.0, 10.0), seeds=5),
        Grid(**_PUSHER, dt_ms=(5.0, 10.0), seeds=5),
        Grid(**_FOUR, dt_ms=(5.0, 10.0), seeds=5),
        Grid(platform="sensors", test=("lidar", "camera", "camera-in-view"), seeds=5),
        Grid(platform="sensors", test=("lidar-noise", "sonar", "sonar-thin", "schedule"), seeds=1),
        Grid(platform=_ROBOTS, test="noise", seeds=100),
    )


QUICK = Size(
    "quick",
    grids=(
        *_wheels((5.0,), (0.8, 2.0), (0.4,)),
        Grid(platform="koala", test="straight", seeds=2),
        Grid(platform="nims", test="move", variant=_NIMS, speed=1.0, dt_ms=10.0, seeds=1),
        Grid(platform="nims", test=("pendulum", "tension"), variant=_NIMS, dt_ms=10.0, seeds=1),
        Grid(
            platform="aibo_ers7", test="walk", variant=("forward", "left"), friction=0.6,
            dt_ms=4.0, seeds=1,
        ),
        Grid(platform="aibo_ers7", test="straight", friction=0.6, dt_ms=4.0, seeds=1),
        Grid(platform="aibo_ers7", test="roll", dt_ms=4.0, seeds=1),
        Grid(
            platform="aibo_ers7", test="get-up", variant=("front", "back"), friction=0.6,
            dt_ms=4.0, seeds=2,
        ),
        Grid(
            platform="aibo_ers7", test="kick", variant=("forward", "left"), friction=0.6,
            dt_ms=4.0, seeds=2,
        ),
        Grid(**_TJ_PRO, dt_ms=10.0, seeds=1),
        Grid(**_PUSHER, dt_ms=10.0, seeds=1),
        Grid(**_FOUR, dt_ms=10.0, seeds=1),
        Grid(
            platform="sensors",
            test=("lidar", "camera", "camera-in-view", "lidar-noise", "schedule"), seeds=1,
        ),
        Grid(platform=_ROBOTS, test="noise", seeds=3),
    ),
    default_seeds=1,
    expected_minutes=0.5,
    note="one timestep, one friction, no crowds, few falls and kicks; decides what one run can",
)  # fmt: skip
STANDARD = Size("standard", grids=_large(30, 3), default_seeds=30, expected_minutes=20.0)
FULL = Size(
    "full",
    grids=_large(100, 10),
    default_seeds=100,
    expected_minutes=60.0,
    note="100 falls, kicks and draws of grip of each kind, 10 worlds of each crowd",
)
