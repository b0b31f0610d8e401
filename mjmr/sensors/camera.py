"""Camera: colour, depth and segmentation images, rendered when they are first read."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.geometry import Pinhole, look_at, rotation_matrix
from mjmr.randomness import SampleNoise
from mjmr.robots.platform import FLOOR
from mjmr.sensors.base import Sensor, carrier_body
from mjmr.sensors.image_errors import GainField, PixelNoise

if TYPE_CHECKING:
    import mujoco

Array = NDArray[np.float64]
# dtype, channels, and what a pixel is where there is no image or nothing to see
_KINDS: dict[str, tuple[Any, tuple[int, ...], float]] = {
    "rgb": (np.uint8, (3,), 0),
    "depth": (np.float32, (), np.nan),
    "segmentation": (np.int32, (), -1),
}
_BOUNDS = {"rgb": (0, 255), "depth": (0.0, np.inf), "segmentation": (-1, np.inf)}
MODALITIES = tuple(_KINDS)


class Camera(Sensor):
    """An ideal pinhole that errors may be added to: on every robot of a group, or in the world.

    On robots, ``group.mount(Camera(...))``: at a camera of their model, or at a pose on one of
    their bodies. In the world, ``world.add_camera(Camera(...), position=..., look_at=...)``.

    It sees shapes as MuJoCo draws them, without shadows, reflections, haze, blur or exposure
    time, each pixel by one ray through its middle. Images that nobody reads are never rendered.
    """

    name = "camera"
    stands = True

    def __init__(
        self,
        *,
        modality: str = "rgb",
        width: int = 640,
        height: int = 480,
        fovy: float | None = None,
        rate: float = 30.0,
        latency: float = 0.0,
        phase: float = 0.0,
        at: str = "",
        body: str = "",
        position: ArrayLike | None = None,
        look_at: ArrayLike | None = None,
        quaternion: ArrayLike | None = None,
        noise: float = 0.0,
        vignetting: float = 0.0,
        unevenness: float = 0.0,
        loss: float = 0.0,
    ):
        """Set image, schedule, place and errors.

        Args:
            modality: One of ``MODALITIES``.
            width: [px].
            height: [px].
            fovy: Vertical field of view [rad], pi / 3 by default; a camera of the robot's model has
                its own.
            rate: Images a second [Hz].
            latency: From exposure to delivery [s].
            phase: Instant of the first image [s].
            at: Name of a camera in the robot's model; or give a position.
            body: Of the robot, whose frame ``position`` and so on are in; default: its first.
            position: Optical centre (3,) [m].
            look_at: Point it looks at (3,) [m].
            quaternion: Orientation (w, x, y, z) instead, MuJoCo's convention: looks along -z, +y is
                up in the image.
            noise: Standard deviation of every pixel and channel [grey levels].
            vignetting: Share of the light lost in the corners, 0 to 1.
            unevenness: Share of the light lost at the right edge against the left, 0 to 1.
            loss: Probability that an image is never delivered.

        Raises:
            UnknownNameError: Unknown modality.
            InvalidInputError: A size, angle, place or error that cannot be.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        if modality not in _KINDS:
            raise UnknownNameError("modality", modality, MODALITIES)
        if not (width == int(width) and height == int(height) and min(width, height) > 0):
            raise InvalidInputError(f"an image has at least 1 x 1 px; got {width} x {height}")
        if fovy is not None and not 0 < fovy < math.pi:
            raise InvalidInputError(f"fovy lies between 0 and pi rad; got {fovy}")
        if not 0 <= noise <= 100:
            raise InvalidInputError(f"noise is a deviation of 0 to 100 grey levels; got {noise}")
        for name, share in (("vignetting", vignetting), ("unevenness", unevenness), ("loss", loss)):
            if not 0 <= share <= 1:
                raise InvalidInputError(f"{name} is a share, 0 to 1; got {share}")
        if modality != "rgb" and (noise or vignetting or unevenness):
            raise InvalidInputError(
                f"noise, vignetting and unevenness spoil rgb images; this camera's are {modality}"
            )
        if at and not (body == "" and position is look_at is quaternion is fovy is None):
            raise InvalidInputError(
                f"the model's camera {at!r} has a body, pose and field of view of its own; give "
                "its name alone"
            )
        self.modality, self.width, self.height = modality, int(width), int(height)
        self.fovy = math.pi / 3 if fovy is None else float(fovy)
        self.noise, self.vignetting, self.unevenness = noise, vignetting, unevenness
        self.loss = loss
        self._at, self._body = at, body
        self._standing = False
        self._pose = None if position is None else _pose(position, look_at, quaternion)

    def stand(
        self, position: ArrayLike, look_at: ArrayLike | None, quaternion: ArrayLike | None
    ) -> None:
        """Stand in the world; :meth:`mjmr.world.World.add_camera` calls this."""
        if self._at or self._body or self._pose or self._standing or self.carrier is not None:
            raise InvalidInputError("this camera has a place already; make another one")
        self._pose, self._standing = _pose(position, look_at, quaternion), True

    def read(self) -> NDArray[Any]:
        """Newest image that was due for delivery by now; read-only.

        Shape (n, height, width, ...) on robots, (height, width, ...) in the world: ``rgb`` uint8
        with three channels; ``depth`` float32 along the optical axis [m], infinite where there is
        nothing; ``segmentation`` int32 labels, see :attr:`label_names`, -1 where there is nothing.

        An image that was lost, and every one before the first delivery, is black, NaN or -1
        throughout, never an older one again; :attr:`fresh` tells.

        Raises:
            MissingGLError: No off-screen OpenGL.
            InvalidInputError: The camera is in no simulation yet.
        """
        return super().read()

    @property
    def reading_bounds(self) -> tuple[ArrayLike, ArrayLike]:
        """Of a pixel."""
        return _BOUNDS[self.modality]

    @property
    def fresh(self) -> NDArray[np.bool_] | bool:
        """Whether :meth:`read` returns an image, shape (n,) on robots: due and not lost."""
        sample = self._newest()
        kept = self._kept(sample.number) if sample else np.zeros(self._count, dtype=bool)
        return bool(kept[0]) if self._standing else kept

    @property
    def calibration(self) -> Pinhole:
        """The ideal camera: in the world frame, or on robots in that of the body it is fixed to."""
        if self._at:
            return self._studio().calibration(self._cameras()[0], self.width, self.height)
        if self._pose is None:
            raise InvalidInputError("this camera has no place yet; mount it or stand it somewhere")
        position, rotation = self._pose
        focal = self.height / 2 / math.tan(self.fovy / 2)
        return Pinhole(position, rotation, focal, self.width, self.height)

    @property
    def label_names(self) -> tuple[str, ...]:
        """What the labels of a segmentation stand for; the team's robots come first."""
        return self._studio().label_names

    def add_to(self, spec: "mujoco.MjSpec", prefixes: Sequence[str], key: str) -> None:
        """Add a camera to the world or each robot, or check that the model has the one named."""
        taken = [c.name for c in spec.cameras]
        if all(prefixes):
            # the nearest thing drawn is some 2 cm away, not a hundredth of the hall: other robots
            # come close; the floor is about half as long as the extent that znear is a share of
            reach = float(max(spec.geom(FLOOR).size[:2]))
            spec.visual.map.znear = min(spec.visual.map.znear, 0.01 / reach)
        for prefix in prefixes:
            name = f"{prefix}{self._at or key}"
            if self._at:
                if name not in taken:
                    own = [c.removeprefix(prefix) for c in taken if c.startswith(prefix)]
                    raise UnknownNameError("camera of the robot's model", self._at, own)
                continue
            if name in taken:
                raise InvalidInputError(f"the model has a camera named {name!r}; mount as another")
            if self._pose is None:
                raise InvalidInputError(f"the camera {key!r} has no place; give at or a position")
            position, rotation = self._pose
            carrier_body(spec, prefix, self._body).add_camera(
                name=name,
                pos=position,
                xyaxes=[*rotation[:, 0], *-rotation[:, 1]],
                fovy=math.degrees(self.fovy),
            )

    def prepare(self, sequence: np.random.SeedSequence, group: Any) -> None:
        """Set up the noise streams, and remember what the model calls the cameras."""
        assert self._simulation is not None
        if self._standing and group is not None:
            raise InvalidInputError("this camera stands in the world; mount another one on robots")
        mounted: Any = self._simulation.world.sensors if group is None else group.sensors
        key = next(key for key, sensor in mounted.items() if sensor is self)
        prefixes = [""] if group is None else group.prefixes
        self._names = [f"{prefix}{self._at or key}" for prefix in prefixes]
        noise, loss = sequence.spawn(2)
        self._count = 1 if group is None else group.n
        self._losses = SampleNoise(loss, (self._count,), "uniform")
        self._pixels = PixelNoise(noise, self._count, self.noise) if self.noise else None
        self._gain = None
        if self.vignetting or self.unevenness:
            self._gain = GainField(self.width, self.height, self.vignetting, self.unevenness)
        self._ids: list[int] = []

    def observe(self, time: float) -> Any:
        """What the scene looks like now."""
        assert self._simulation is not None
        return self._simulation.visible_state()

    def compute(self, state: Any, number: int) -> NDArray[Any]:
        """Render what was delivered, then spoil it."""
        images, kept = self._blank(), self._kept(number)
        if kept.any():
            studio, cameras = self._studio(), self._cameras()
            studio.show(state)
            for i in np.flatnonzero(kept):
                images[i] = studio.picture(self.modality, cameras[i], self.width, self.height)
            if self._gain is not None:
                self._gain.apply(images)
            if self._pixels is not None:
                self._pixels.add(images, number)
                images[~kept] = 0
        return images[0] if self._standing else images

    def nothing(self) -> NDArray[Any]:
        """A blank image."""
        return self._blank()[0] if self._standing else self._blank()

    def _blank(self) -> NDArray[Any]:
        dtype, channels, empty = _KINDS[self.modality]
        return np.full((self._count, self.height, self.width, *channels), empty, dtype=dtype)

    def _kept(self, number: int) -> NDArray[np.bool_]:
        return self._losses.sample(number) >= self.loss

    def _studio(self) -> Any:
        if self._simulation is None:
            raise InvalidInputError("the camera can be asked once it is in a simulation")
        return self._simulation.studio

    def _cameras(self) -> list[int]:
        model = self._studio().model
        if not self._ids:
            self._ids = [model.camera(name).id for name in self._names]
        return self._ids


def _pose(position: Any, target: Any, quaternion: Any) -> tuple[Array, Array]:
    """Position (3,) and rotation (3, 3): right, down, forward."""
    if (target is None) == (quaternion is None):
        raise InvalidInputError("give a camera either look_at or a quaternion")
    where = np.array(position, dtype=np.float64)
    aim = np.array(quaternion if target is None else target, dtype=np.float64)
    if where.shape != (3,) or aim.shape != ((4,) if target is None else (3,)):
        raise InvalidInputError(
            "a camera's position and look_at have three numbers each, a quaternion four"
        )
    if not (np.isfinite(where).all() and np.isfinite(aim).all()):
        raise InvalidInputError("a camera's pose must be finite")
    if target is not None:
        if np.linalg.norm(aim - where) < 1e-6:
            raise InvalidInputError("a camera cannot look at the point where it is")
        return where, look_at(where, aim)
    if np.linalg.norm(aim) < 1e-6:
        raise InvalidInputError("a camera's quaternion must not be zero")
    return where, rotation_matrix(aim) * [1.0, -1.0, -1.0]
