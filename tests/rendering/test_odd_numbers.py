# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene, camera or setting with a number that no picture can be made of is refused with a sentence."""

import math
from collections.abc import Iterator
from dataclasses import fields, replace

import numpy as np
import pytest

from splat_addon.faults import is_worded
from splat_addon.images import Image
from splat_addon.rendering import (
    Camera,
    Environment,
    EquidistantFisheye,
    Equirectangular,
    EquisolidFisheye,
    Finish,
    GlossTexture,
    Instance,
    Lens,
    Light,
    Lines,
    Matcap,
    Material,
    NormalTexture,
    Panorama,
    Ramp,
    Scene,
    Settings,
    SurfaceTexture,
)
from splat_addon.surfels import empty_surfels

PIXEL = Image(np.ones((1, 1, 4)))
#: Each kind of thing with plain numbers, which are replaced one at a time.
PLAIN = [
    Camera(np.eye(4), (-1, 1, -1, 1), (8, 8)),
    Camera(np.eye(4), (-1, 1, -1, 1), (8, 8), is_orthographic=True),
    Panorama(np.eye(4), EquidistantFisheye(3.0), (8, 8)),
    EquidistantFisheye(3.0),
    Equirectangular(),
    EquisolidFisheye(3.0, 10.0, (36.0, 24.0)),
    Lens(0.1, 1.0),
    *(Light(kind) for kind in ("sun", "point", "spot", "area")),
    Material(),
    Finish(),
    SurfaceTexture(PIXEL),
    NormalTexture(PIXEL),
    GlossTexture(PIXEL),
    PIXEL,
    Environment(np.ones((2, 4, 3))),
    Instance(empty_surfels()),
    Instance(empty_surfels(), split_distance=1.0),
    Instance(empty_surfels(), split_length=1.0),
    Scene(background=(0.0, 0.0, 0.0)),
    Settings(),
    Lines(),
    Ramp(np.ones((2, 3))),
    Matcap(np.ones((2, 2, 3))),
]
#: No thing takes them in place of a number, but for an infinite distance of occlusion.
NEVER = (math.nan, math.inf, -math.inf)
OTHERS = (0, -1, 1e300, -1e300, 1e39, 1e-300, 0.5, 2.5)


def with_odd(value, odd: float) -> Iterator:
    """The value with one of its numbers replaced; nothing if it has none."""
    if isinstance(value, np.ndarray) and value.dtype.kind == "f":
        changed = value.astype(np.float64)
        changed.flat[0] = odd
        yield changed
    elif isinstance(value, tuple):
        for place, part in enumerate(value):
            yield from ((*value[:place], changed, *value[place + 1 :]) for changed in with_odd(part, odd))
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield odd


@pytest.mark.parametrize("plain", PLAIN, ids=lambda plain: type(plain).__name__)
def test_every_odd_number_is_taken_or_refused_with_a_sentence(plain):
    tried = 0
    for field in fields(plain):
        for odd in (*NEVER, *OTHERS) * field.init:
            for value in with_odd(getattr(plain, field.name), odd):
                tried += 1
                try:
                    with np.errstate(over="ignore"):
                        replace(plain, **{field.name: value})
                except Exception as error:
                    assert is_worded(error), f"{field.name} {value}: {error!r}"
                else:
                    is_any = field.name == "rotation" or (field.name, odd) == ("ambient_occlusion", math.inf)
                    assert odd not in (*NEVER, 1e300, -1e300) or is_any, (field.name, value)
    assert tried >= len(NEVER)


def test_a_camera_without_room_is_refused_and_a_sheared_one_is_not():
    flat = np.array([(-1.0, -1, 1, 0), (0, 0, 0, -4), (4e-46, -2e-45, -4e-46, 0), (0, 0, 0, 1)])
    with pytest.raises(ValueError, match="axes in a plane"):
        Camera(flat, (-1, 1, -1, 1), (8, 8))
    sheared = np.eye(4)
    sheared[0, 1] = 100.0
    assert np.isfinite(Camera(sheared, (-1, 1, -1, 1), (8, 8)).world_to_view()).all()
