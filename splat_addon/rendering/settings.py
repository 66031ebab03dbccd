# SPDX-License-Identifier: GPL-3.0-or-later
"""Render settings: one frozen set of choices that the Blender properties mirror."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .frame import OUTPUTS
from .methods import get_method
from .scene.eye_dome import EyeDome
from .scene.lines import Lines
from .scene.matcap import Matcap
from .scene.numbers import MAX_FACTOR, MAX_LENGTH
from .scene.ramp import Ramp
from .shading_models import get_shading_model

#: sum_format -> (label, what it costs and gains)
SUM_FORMATS = {
    "float32": ("Float 32", "Exact, even with thousands of splats over a pixel"),
    "float16": (
        "Float 16",
        "Takes less memory. Precise with hundreds of splats over a pixel, wrong with thousands",
    ),
}

MAX_SUPERSAMPLING = 16

MAX_SAMPLES = 4096

MAX_TOON_STEPS = 16

#: Hardware samples per pixel; 0 for none.
MULTISAMPLING = (0, 2, 4, 8)

#: Eight maps of this size side by side make the widest texture that every tested backend supports.
MAX_SHADOW_RESOLUTION = 2048

MAX_LAYERS = 64

MAX_BOUNCES = 16

#: Of the Gaussian that filters a pixel, square pixels; and the most that three columns of a silhouette can have.
MIN_FILTER_VARIANCE, MAX_FILTER_VARIANCE, MAX_SILHOUETTE_VARIANCE = 0.2, 4.0, 2 / 3

EVEN_RAMP = Ramp.of_steps(3)

#: Outputs that follow the nearest sample of a pixel.
NEAREST = ("depth", "position", "object_index", "material_index")


def held_arrays(outputs: tuple[str, ...]) -> tuple[str, ...]:
    """The arrays of a frame with these outputs; outputs that follow the nearest sample include its depth."""
    return tuple(name for name in OUTPUTS if name in outputs or (name == "depth" and set(outputs) & set(NEAREST)))


@dataclass(frozen=True)
class Settings:
    """method: how a splat is rasterized and filtered, a name in `rendering.methods`.
    shading: a name in `rendering.shading_models`.
    toon_steps: levels of each light in the toon model, at least 2. toon_softness: width of their edges, as a share of a
        level's.
    matcap: what that model looks up. ramp: the same for that model; three even greys unless another is given.
    eye_dome: darkens surfaces whose surroundings rise towards the viewer, with any shading; None for none.
    lines: drawn along silhouettes and creases, with any shading; None for none.
    supersampling: N for N x N samples per pixel, averaged with a box filter.
    samples: number of pictures that are averaged, each with a different offset in the pixel and a different point on
        the camera's lens, if it has one. Offsets are a box filter one pixel wide on top of the method's own filter;
        Mip Filter and EWA make theirs narrower by that.
    multisampling: samples that the hardware tests for depth in each of those, for methods that work in space; a device
        has what its `multisample_counts` name, and Blender's has none.
    sample_shading: of multisampling, evaluate splats and light at every sample, not once a pixel.
    filter_variance: of the Gaussian that filters a pixel, in square pixels, for the methods that have one (Mip Filter,
        EWA, EWA in Space); the pixels of `reference.filters` have the default, the papers 1.
    edge_threshold: where splats' weights sum to less, the pixel fades to the background (the view-independent paper's
        threshold, section 4.5); 1 is one splat's centre, 0 covers whatever a splat reaches. As printed, the sums below
        it are not normalised, so that the picture jumps at the threshold.
    epsilon: how far, in radii of each splat, the visibility pass moves it back along the view ray;
        surfaces closer than that mix (0.5 to 5 is a plateau, 0 breaks the picture up).
    epsilon_length: the same for all splats, in scene units, on top of that. The papers have this alone.
    detail_tolerance: of surfels that are too small to be seen one by one, merged ones are drawn that are off by
        at most this many pixels, in each view (the camera's, and each shadow map's in its texels); 0 draws all.
    shadow_resolution: texels along the side of a shadow map; 0 disables shadows.
    ambient_occlusion: distance, in scene units, up to which visible surfaces block the world's light from one another;
        0 disables it, and infinity is half the distance to the viewer.
    reflections: glossy objects reflect what stands around them, and not only the world.
    refraction: what transmits light shows what is behind it; otherwise it is drawn opaque.
    bounces: how often surfaces reflect light to one another before it counts no more; 0 disables bounced light, and
        with it emission as light, and what is in the way of the world's.
    layers: maximum number of transparent surfaces behind one another per pixel. blends_rest: the last layer blends all
        remaining surfaces without order, each splat lit by itself; otherwise they are lost.
    alpha_threshold: minimum opacity of the surface that depth and normal are taken from.
    transparent_film: omit the background and leave its alpha at 0.
    outputs: the requested arrays of the `Frame`; the others are None and cost nothing. A position and an index bring
        the depth that they belong to.
    lights_splats: light each splat where it stands and blend their colours, as Botsch and Kobbelt 2003 do, instead of
        lighting the sample that they blend to.
    culls_backs: skip splats that face away, also for open surfaces (Botsch and Kobbelt 2003, section 4).
    as_printed: follow the papers where this project has rules of its own. Backs are drawn as fronts, where else they
        weigh little beside one; the last transparent layer hides as one surface does, not as all that it holds; EWA's
        filter has variance 1; splats have neither blend depths nor smaller weights where they are large; normal fields
        are whole; below the edge threshold a pixel is as opaque as its weights sum to; splats and polygons are lit
        apart, and their colours blended, whichever way both face.
    storage: the format of surfels on the device, a name in `upload.storages`.
    sum_format: of the sums of colour and material, a name in `SUM_FORMATS`.
    profile: wait for the device after each pass, so that the frame's statistics contain the time of each.
    """

    method: str = "mip"
    shading: str = "principled"
    toon_steps: int = 3
    toon_softness: float = 0.1
    matcap: Matcap | None = None
    ramp: Ramp = EVEN_RAMP
    eye_dome: EyeDome | None = None
    lines: Lines | None = None
    supersampling: int = 1
    samples: int = 1
    multisampling: int = 0
    sample_shading: bool = False
    filter_variance: float = 0.5
    edge_threshold: float = 0.0
    epsilon: float = 0.5
    epsilon_length: float = 0.0
    detail_tolerance: float = 1.0
    shadow_resolution: int = 1024
    ambient_occlusion: float = 0.0
    reflections: bool = False
    refraction: bool = False
    bounces: int = 0
    layers: int = 3
    blends_rest: bool = True
    alpha_threshold: float = 0.5
    transparent_film: bool = False
    outputs: tuple[str, ...] = ("color", "depth", "normal", "coverage")
    lights_splats: bool = False
    culls_backs: bool = False
    as_printed: bool = False
    storage: str = "float32"
    sum_format: str = "float32"
    profile: bool = False

    def __post_init__(self):
        if "matcap" in get_shading_model(self.shading).tables and self.matcap is None:
            raise ValueError("Matcap shading needs a picture of a ball: choose one as its matcap.")
        if not isinstance(self.ramp, Ramp):
            raise ValueError(f"ramp must be a Ramp, not {self.ramp!r}.")
        if self.toon_steps not in range(2, MAX_TOON_STEPS + 1):
            raise ValueError(f"toon_steps must be 2 to {MAX_TOON_STEPS}, not {self.toon_steps}.")
        if not 0 <= self.toon_softness <= 1:
            raise ValueError(f"toon_softness must be 0 to 1, not {self.toon_softness}.")
        if self.sum_format not in SUM_FORMATS:
            raise ValueError(f"sum_format must be one of {', '.join(SUM_FORMATS)}, not {self.sum_format!r}.")
        if self.supersampling not in range(1, MAX_SUPERSAMPLING + 1):
            raise ValueError(f"supersampling must be 1 to {MAX_SUPERSAMPLING}, not {self.supersampling}.")
        if self.samples not in range(1, MAX_SAMPLES + 1):
            raise ValueError(f"samples must be 1 to {MAX_SAMPLES}, not {self.samples}.")
        if self.multisampling not in MULTISAMPLING:
            raise ValueError(f"multisampling must be one of {MULTISAMPLING}, not {self.multisampling!r}.")
        most = MAX_SILHOUETTE_VARIANCE if get_method(self.method).filters_silhouettes else MAX_FILTER_VARIANCE
        if not MIN_FILTER_VARIANCE <= self.filter_variance <= most:
            raise ValueError(
                f"filter_variance must be {MIN_FILTER_VARIANCE:g} to {most:.3g} square pixels with method "
                f"{self.method}, not {self.filter_variance}."
            )
        if not 0 <= self.edge_threshold <= MAX_FACTOR:
            raise ValueError(f"edge_threshold must be 0 or more splat weights, not {self.edge_threshold}.")
        if not 0 <= self.detail_tolerance <= MAX_FACTOR:
            raise ValueError(f"detail_tolerance must be 0 or more pixels, not {self.detail_tolerance}.")
        if self.shadow_resolution not in range(MAX_SHADOW_RESOLUTION + 1):
            raise ValueError(f"shadow_resolution must be 0 to {MAX_SHADOW_RESOLUTION}, not {self.shadow_resolution}.")
        if not (0 <= self.ambient_occlusion <= MAX_LENGTH or self.ambient_occlusion == math.inf):
            raise ValueError(
                f"ambient_occlusion must be a distance of 0 or more, or infinite, not {self.ambient_occlusion}."
            )
        if self.bounces not in range(MAX_BOUNCES + 1):
            raise ValueError(f"bounces must be 0 to {MAX_BOUNCES}, not {self.bounces}.")
        if self.layers not in range(1, MAX_LAYERS + 1):
            raise ValueError(f"layers must be 1 to {MAX_LAYERS}, not {self.layers}.")
        if self.blends_rest and self.layers < 2:
            raise ValueError(
                "layers must be 2 or more if the last one blends the rest, because that needs a layer in front of it."
            )
        if self.lights_splats and (blind := set(self.outputs) & {"diffuse_color", "emission", "shadow"}):
            raise ValueError(
                f"Splats that are lit one by one provide no {', '.join(sorted(blind))}: leave these outputs out, or "
                "set lights_splats to False."
            )
        if not 0 <= self.alpha_threshold <= 1:
            raise ValueError(f"alpha_threshold must be 0 to 1, not {self.alpha_threshold}.")
        if not set(self.outputs) <= set(OUTPUTS):
            raise ValueError(f"outputs must be among {', '.join(OUTPUTS)}, not {self.outputs!r}.")
        if not 0 <= self.epsilon <= MAX_FACTOR:
            raise ValueError(f"epsilon must be 0 or more splat radii, not {self.epsilon}.")
        if not 0 <= self.epsilon_length <= MAX_LENGTH:
            raise ValueError(f"epsilon_length must be a length of 0 or more, not {self.epsilon_length}.")

    @property
    def use_ambient_occlusion(self) -> bool:
        return self.ambient_occlusion > 0

    @property
    def gaussian_variance(self) -> float:
        """Variance of the pixel's Gaussian, square pixels: the paper's if as printed, or the chosen one; of methods
        that do not choose, the default."""
        method = get_method(self.method)
        if method.pixel_variance is not None:
            return Settings.filter_variance
        return method.printed_variance if self.as_printed and method.printed_variance else self.filter_variance

    @property
    def pixel_variance(self) -> float:
        """Variance of the method's pixel filter, square pixels."""
        own = get_method(self.method).pixel_variance
        return self.gaussian_variance if own is None else own
