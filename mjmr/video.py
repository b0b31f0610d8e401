"""H.264 files that play in every browser."""

import os
from fractions import Fraction
from pathlib import Path
from types import TracebackType

import av
import cv2
import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError


class VideoWriter:
    """Writes RGB pictures to an MP4 file (H.264, yuv420p, index in front).

    The file appears under its name when it is complete, not before.
    """

    def __init__(self, path: str | Path, width: int, height: int, fps: int = 30):
        """Open.

        Args:
            path: The file to write; its folder must exist.
            width: [px], even.
            height: [px], even.
            fps: Pictures a second.

        Raises:
            InvalidInputError: An odd size.
        """
        if width % 2 or height % 2:
            raise InvalidInputError(f"H.264 needs an even width and height; got {width}x{height}")
        self.path = Path(path)
        self._partial = self.path.with_name(f".{self.path.name}.{os.getpid()}.part")
        self._container = av.open(
            str(self._partial), "w", format="mp4", options={"movflags": "+faststart"}
        )
        # one thread: pictures take longer to render than to encode, and every thread takes memory
        options = {"preset": "veryfast", "crf": "21", "threads": "1"}
        self._stream = self._container.add_stream("libx264", rate=Fraction(fps), options=options)
        self._stream.width, self._stream.height = width, height
        self._stream.pix_fmt = "yuv420p"
        self.frames = 0

    def write(self, picture: NDArray[np.uint8]) -> None:
        """Append one picture, shape (height, width, 3)."""
        # a tenth of the time libswscale takes
        planes = np.asarray(cv2.cvtColor(picture, cv2.COLOR_RGB2YUV_I420), dtype=np.uint8)
        frame = av.VideoFrame.from_ndarray(planes, format="yuv420p")
        self._container.mux(self._stream.encode(frame))
        self.frames += 1

    def close(self) -> None:
        """Finish the file."""
        self._container.mux(self._stream.encode(None))
        self._container.close()
        self._partial.replace(self.path)

    def __enter__(self) -> "VideoWriter":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if kind is None:
            self.close()
        else:
            self._container.close()
            self._partial.unlink(missing_ok=True)
