# SPDX-License-Identifier: GPL-3.0-or-later
"""What a picture of many instances costs while the 3D view's camera moves around them, as coarse as its rate makes it.

*ms* is the processor time of a picture, the median of the second half of an orbit, whose clock is that time, too.
*Planned* is that of pictures as coarse, of a camera that moves, whose draw calls are left out. *Pixels* are along each
side, *tolerance* is that of the last picture.
"""

from __future__ import annotations

import math
from time import process_time

from bench.scenes import PLACED, Undrawn, field
from measuring.timing import Spread, processor
from splat_addon.rendering import Camera, Pace, Refinement, Renderer, Scene, Settings, look_at, open_device

DEVICES = ("standalone", "blender")
QUICK = {"size": 16, "instances": 20, "views": 2}
#: The camera's turn from picture to picture, radians, and its distance and height over the middle.
TURN, AWAY, ABOVE = 0.01, 14, 7
COLUMNS = ["scene", "instances", "ms", "pixels", "tolerance", "planned, ms"]


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, default=384, help="pixels along each side")
    parser.add_argument("--instances", type=int, default=4000)
    parser.add_argument("--views", type=int, default=30, help="of an orbit")
    parser.add_argument("--rate", type=float, default=10, help="pictures a second that it asks for")


def run(options, report) -> None:
    device = open_device(options.device)
    asked = f"{options.rate:g} pictures a second asked"
    report.header(device, f"{options.size} x {options.size} pixels, a sun's shadows, {asked}")
    report.table(COLUMNS, (row(device, kind, options) for kind in PLACED))


def row(device, kind: str, options) -> tuple[str, ...]:
    scene, seen, pace = (
        field(kind, options.instances, suns=1, is_shared=True),
        Followed(Renderer(device)),
        Timed(options),
    )
    view, number = Refinement(seen, pace), 0
    while len(pace.spent) < options.views:
        # as in a view that is redrawn, a picture that takes longer than a call ends among the next ones
        for shown in view.draw(scene, eye(number, options.size), Settings()):
            device.finish(device.target([shown.texture]))
        number += 1
    spent = pace.spent
    camera, settings = seen.last
    bare = Renderer(Undrawn(device))
    moved = (eye(step, camera.size[0]) for step in range(options.views))
    planned = [processor(lambda each=each: [*bare.draw(scene, each, settings)])[0] for each in moved]
    tolerance = f"{settings.detail_tolerance:.3g}" if kind == "surfels" else ""
    cells = f"{median(spent):.1f}", camera.size[0], tolerance, f"{median(planned):.1f}"
    return kind, f"{options.instances:,}", *cells


class Followed:
    """A renderer that keeps the camera and the settings of the last picture that it was asked for."""

    def __init__(self, renderer: Renderer):
        self._renderer = renderer

    def __getattr__(self, name: str):
        return getattr(self._renderer, name)

    def draw(self, scene: Scene, camera: Camera, settings: Settings, **options):
        self.last = camera, settings
        return self._renderer.draw(scene, camera, settings, **options)


class Timed(Pace):
    """Keeps what each picture took, processor seconds."""

    def __init__(self, options):
        super().__init__(options.rate, clock=process_time)
        self.spent: list[float] = []

    def end(self, *told) -> None:
        self.spent.append(self._clock() - self._started)
        super().end(*told)


def eye(number: int, size: int) -> Camera:
    angle = TURN * number
    place = AWAY * math.sin(angle), -AWAY * math.cos(angle), ABOVE
    return Camera.perspective(look_at(place, (0, 0, 0)), 0.7, (size, size))


def median(seconds: list[float]) -> float:
    """Of the second half, in milliseconds."""
    return 1e3 * Spread.of(seconds[len(seconds) // 2 :]).median
