"""How a film looks; light to import, so that the command line can check it."""

from dataclasses import dataclass

from mjmr.errors import InvalidInputError, UnknownNameError

CAMERAS = ("overview", "corner", "chase")
LOOKS = ("draft", "fine")


@dataclass(frozen=True, kw_only=True)
class FilmOptions:
    """How a film looks.

    Attributes:
        camera: ``"overview"``: the whole world from above; ``"corner"``: the whole world from
            above its lower left corner, slanting; ``"chase"``: behind one robot.
        follow: The robot that ``chase`` follows, index in the team.
        look: ``"draft"`` or ``"fine"`` (shadows, smooth edges; several times slower).
        width: [px], even.
        height: [px], even.
        fps: Pictures a second.
        speed: Simulated seconds shown a second; None: real time, faster only where the film would
            exceed a minute.
        trail: How long the lines are that robots leave behind them [s]; inf: since the start.
    """

    camera: str = "overview"
    follow: int = 0
    look: str = "draft"
    width: int = 1280
    height: int = 720
    fps: int = 30
    speed: float | None = None
    trail: float = 1.2

    def __post_init__(self):
        if self.camera not in CAMERAS:
            raise UnknownNameError("camera", self.camera, CAMERAS)
        if self.look not in LOOKS:
            raise UnknownNameError("look", self.look, LOOKS)
        if self.width % 2 or self.height % 2 or min(self.width, self.height) < 120:
            raise InvalidInputError(
                f"a film's size must be even and at least 120 px; got {self.width}x{self.height}"
            )
        if self.fps < 1:
            raise InvalidInputError(f"fps must be at least 1; got {self.fps}")
        if not self.trail >= 0:
            raise InvalidInputError(f"a trail lasts 0 s or more; got {self.trail}")
        if self.speed is not None and not self.speed > 0:
            raise InvalidInputError(f"speed must be positive; got {self.speed}")
