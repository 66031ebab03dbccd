# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns a graph of images that all lie at one place into a single image, computed pixel by pixel.

That image can be drawn on polygons, looked up at render time, and filtered like any other.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....sampling import Image
from ....shading_nodes import ATTRIBUTE, ATTRIBUTE_ALPHA, LAYERS, Graph, Inputs, Step, evaluate, pruned
from ..node_products import ImageSource
from ..node_walks import Node

#: Kinds of steps that take the colour or the alpha from a looked up image -> those that take it from a layer.
_TAKEN = {"rgb": ATTRIBUTE, "component": ATTRIBUTE_ALPHA}


def flattened(
    graph: Graph, images: dict[int, tuple[Node, bool]], layers, alpha_of: Node | None
) -> tuple[Image, Node] | None:
    """The image that a graph is, and an Image Texture node that lies where it lies; None if it is more than that.

    images: as `GraphReading.graph` gives them. alpha_of: the node whose alpha the image takes; None: it is opaque.
    """
    used = {number: graph.steps[number] for number in images}
    firsts = [step.settings[0] for step in used.values()]
    places = {(step.kind, step.inputs[0], *step.settings[1:]) for step in used.values()}
    manners = {(image.extension, image.interpolation) for image in firsts}
    is_one = len(places) == len(manners) == 1 and next(iter(places))[0] == "image" and "FLAT" in next(iter(places))
    if not is_one or (alpha_of is not None and alpha_of not in (node for node, _ in images.values())):
        return None
    on_pixels = _on_pixels(graph, list(images))
    if on_pixels is None:
        return None
    alpha = None if alpha_of is None else layers.image(ImageSource(alpha_of), True)
    key = "flattened", on_pixels.key, id(alpha), *map(id, firsts)
    kept = layers.kept_images
    if key not in kept:
        # the images go along, so that no other gets their identity
        kept[key] = _computed(on_pixels, firsts, alpha), alpha, firsts
    found = kept[key]
    return (found[0] if isinstance(found, tuple) else found), next(iter(images.values()))[0]


def _on_pixels(graph: Graph, images: list[int]) -> Graph | None:
    """The graph with the images as layers of its samples; None if it reads other layers."""
    steps = list(graph.steps)
    for number, step in enumerate(steps):
        if step.inputs and step.inputs[0] in images:
            steps[number] = Step(_TAKEN[step.kind], (), (images.index(step.inputs[0]),))
    found, order = pruned(steps, len(steps) - 1)
    return None if any(graph.steps[number].kind in LAYERS for number in order) else found


#: Images of fewer pixels along a side are computed finer, up to so many times: they are often magnified, and nodes see
#: what lies between their pixels.
_SMALL, _MOST_FINER = 256, 16


def _computed(graph: Graph, images: list[Image], alpha: Image | None) -> Image:
    largest = max([*images, *[alpha] * (alpha is not None)], key=lambda image: image.pixels.size)
    height, width = largest.pixels.shape[:2]
    if largest.interpolation == "Linear":
        finer = max(1, min(_MOST_FINER, _SMALL // max(height, width)))
        height, width = finer * height, finer * width
    rows = np.concatenate([at_pixels(image, width, height) for image in images])
    pixels = np.ones((4, height * width), np.float32)
    pixels[:3] = evaluate(graph, Inputs(height * width, colors=rows))
    if alpha is not None:
        pixels[3] = at_pixels(alpha, width, height)[3]
    return replace(images[0], pixels=np.ascontiguousarray(pixels.T).reshape(height, width, 4))


def at_pixels(image: Image, width: int, height: int) -> np.ndarray:
    """(4, w h) an image at the pixels of a larger one."""
    if image.pixels.shape[:2] == (height, width):
        return image.pixels.reshape(-1, 4).T
    u, v = ((np.arange(size, dtype=np.float32) + 0.5) / size for size in (width, height))
    at = np.stack([np.tile(u, height), np.repeat(v, width)])
    return image.pyramid.lookup(at, np.zeros(width * height, np.intp)).T
