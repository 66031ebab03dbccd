# SPDX-License-Identifier: GPL-3.0-or-later
"""What settings cost and gain in one scene: drawn with each of them, and compared with its exact pictures.

scene, camera, settings -> exact pictures -> a row for each choice -> a page
scene, camera, settings -> a survey of a few choices -> the choice that keeps a target
"""

from .choices import Choice, choices_for, series_of
from .exact import ExactPictures
from .measuring import Row, measure
from .page import page
from .survey import TIMED_TURNS, Survey
from .target import Pace, Promise, Target, chosen

__all__ = (
    "TIMED_TURNS",
    "Choice",
    "ExactPictures",
    "Pace",
    "Promise",
    "Row",
    "Survey",
    "Target",
    "choices_for",
    "chosen",
    "measure",
    "page",
    "series_of",
)
