"""The study's film: trucks spread round a growing spill, from above and through one's camera."""

import dataclasses
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from controllers.perimeter.vision import red_mask, window
from experiments.perimeter.sizes import GROWTH
from experiments.perimeter.worlds import build
from mjmr.film import Film
from mjmr.film_options import FilmOptions
from mjmr.recording import Recording, record
from mjmr.study import Study

SECONDS = 120.0
SPEED = 30.0  # simulated seconds a second, unless asked otherwise
TRAIL = 60.0  # s
_SEED = 0
_EYE = 0  # truck whose camera is shown
Picture = NDArray[np.uint8]


def film(study: Study, path: Path, options: FilmOptions) -> None:
    """Record and write it."""
    picture(study, options).write(path)


def picture(study: Study, options: FilmOptions, seconds: float = SECONDS) -> Film:
    """The film, to be written or looked at."""
    condition = study.condition(
        task="stay", start="bunch", growth=GROWTH, estimated=True,
        duration=seconds,
    )  # fmt: skip
    recording: Recording = record(study.bound_trial(), condition, _SEED)
    made = Film(
        f"Five trucks on a spill that grows{study.swapped}",
        dataclasses.replace(options, speed=options.speed or SPEED),
    )
    x, y, radius = build(condition, _SEED).lobes[0]
    half = radius + GROWTH * seconds + 2.5
    made.add(
        recording, "lines: who hears whom by radio", (x - half, y - half, x + half, y + half),
        trail=TRAIL,
    )  # fmt: skip
    name = f"tamiya_txt1{_EYE}/eye"
    made.add_eye(
        recording,
        name,
        f"camera of truck {_EYE}, and its mask (tracking by rays)",
        mask,
        (160, 120),
    )
    return made


def mask(image: Picture) -> Picture:
    """What the controller makes of a picture: red is white, with the look-ahead window."""
    shown = cv2.cvtColor(red_mask(image), cv2.COLOR_GRAY2RGB)
    rows, columns = window(image.shape)
    corners = (columns.start, rows.start), (columns.stop - 1, rows.stop - 1)
    cv2.rectangle(shown, *corners, (255, 190, 40), 1)
    return shown  # pyright: ignore[reportReturnType]
