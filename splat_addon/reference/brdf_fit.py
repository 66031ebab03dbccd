# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes brdf_table.npy and edge_table.npy in splat_addon/rendering/shading_models: what the principled shading needs to
know of GGX, tabulated.

    python -m splat_addon.reference.brdf_fit [--out FOLDER]

For each roughness and angle of view: the linear transform that turns a clamped cosine into the lobe (Heitz, Dupuy,
Hill, Neubelt, "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines", 2016, by their fit: least cubed
error, simplex search), the lobe's directional albedo in two terms, so that Schlick's Fresnel can be applied to it
(Karis 2013, "Real Shading in Unreal Engine 4", the split sum), and its mean direction; in the other table, the term of
a metal's tint (Kutz, Hasan, Edmondson 2021). Needs scipy; takes a minute and a half.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from rich.progress import track
from scipy.optimize import minimize

from ..whole_files import whole_file

FOLDER = Path(__file__).resolve().parents[1] / "rendering" / "shading_models"
ROUGHNESS, ANGLES = 48, 32
LEAST_ROUGHNESS = 0.03
SIDE = 40  # samples along each side of the unit square


def unit_square(side: int) -> tuple[np.ndarray, np.ndarray]:
    """Two (side^2,) arrays: the centres of the cells of a grid on the unit square."""
    ticks = (np.arange(side) + 0.5) / side
    return tuple(a.ravel() for a in np.meshgrid(ticks, ticks, indexing="ij"))


class Lobe:
    """D Vis cos of GGX, alpha = roughness^2, height-correlated Smith (Heitz 2014), for one view direction."""

    def __init__(self, roughness: float, cosine: float):
        self.a2 = roughness**4
        self.view = np.array([np.sqrt(1 - cosine**2), 0.0, cosine])

    def value(self, light: np.ndarray) -> np.ndarray:
        """(n,) values of the lobe for unit directions (3, n)."""
        return self.masked(light)[0]

    def masked(self, light: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """For `directions`: the lobe's value, its density, and the cosine between view and half vector."""
        half = light + self.view[:, None]
        half /= np.linalg.norm(half, axis=0)
        nl, nv, nh = np.maximum(light[2], 0), self.view[2], half[2]
        vh = np.maximum(self.view @ half, 1e-9)
        d = self.a2 / (np.pi * ((half[0] ** 2 + half[1] ** 2) + nh**2 * self.a2) ** 2)
        smith = 0.5 / (nl * np.sqrt(nv**2 * (1 - self.a2) + self.a2) + nv * np.sqrt(nl**2 * (1 - self.a2) + self.a2))
        return np.where(nl > 0, d * smith * nl, 0.0), d * nh / (4 * vh), vh

    def directions(self, side: int) -> np.ndarray:
        """(3, side^2) directions distributed as D, reflected."""
        u, v = unit_square(side)
        tan2 = self.a2 * u / (1 - u)
        cosine = 1 / np.sqrt(1 + tan2)
        sine, turn = np.sqrt(1 - cosine**2), 2 * np.pi * v
        half = np.stack([sine * np.cos(turn), sine * np.sin(turn), cosine])
        return 2 * (self.view @ half) * half - self.view[:, None]


def albedo_and_mean(lobe: Lobe) -> tuple[float, float, np.ndarray]:
    """The part of the directional albedo that F0 scales, the other part, and the mean direction."""
    light = lobe.directions(200)
    value, density, vh = lobe.masked(light)
    weight = np.where(value > 0, value / density, 0.0)
    fresnel = (1 - vh) ** 5
    mean = np.array([(weight * light[0]).mean(), 0.0, (weight * light[2]).mean()])
    return (weight * (1 - fresnel)).mean(), (weight * fresnel).mean(), mean / np.linalg.norm(mean)


def edge_table() -> np.ndarray:
    """(48, 32) float32 values of `edge_term`."""
    table = np.zeros((ROUGHNESS, ANGLES), np.float32)
    for i, j in np.ndindex(table.shape):
        table[i, j] = edge_term(Lobe(roughness_of(i), cosine_of(j)))
    return table


def edge_term(lobe: Lobe) -> float:
    """The integral of c (1 - c)^6 over the lobe, where c is the cosine to the half vector."""
    value, density, vh = lobe.masked(lobe.directions(200))
    return (np.where(value > 0, value / density, 0.0) * vh * (1 - vh) ** 6).mean()


def roughness_of(row: int) -> float:
    return LEAST_ROUGHNESS + (1 - LEAST_ROUGHNESS) * row / (ROUGHNESS - 1)


def cosine_of(column: int) -> float:
    """The cosine between normal and viewer for a column of the table."""
    return max(1 - (column / (ANGLES - 1)) ** 2, 1e-3)


def matrix(frame: np.ndarray, parameters) -> np.ndarray:
    """The (3, 3) matrix from a clamped cosine to the lobe."""
    stretch_x, stretch_y, skew = parameters
    return frame @ np.array([[max(stretch_x, 1e-5), 0, skew], [0, max(stretch_y, 1e-5), 0], [0, 0, 1]])


def cosine_directions(side: int) -> np.ndarray:
    u, v = unit_square(side)
    sine, turn = np.sqrt(u), 2 * np.pi * v
    return np.stack([sine * np.cos(turn), sine * np.sin(turn), np.sqrt(1 - u)])


def transformed_density(m: np.ndarray, light: np.ndarray) -> np.ndarray:
    """(n,) density of the transformed cosine at unit directions (3, n)."""
    inverse = np.linalg.inv(m)
    back = inverse @ light
    length = np.linalg.norm(back, axis=0)
    return np.maximum(back[2] / length, 0) / np.pi * abs(np.linalg.det(inverse)) / length**3


def error(lobe: Lobe, albedo: float, m: np.ndarray, of_lobe, of_cosine) -> float:
    """The integral of the cubed difference, from samples of both densities (balance heuristic)."""
    transformed = m @ of_cosine
    total = 0.0
    for light in (of_lobe, transformed / np.linalg.norm(transformed, axis=0)):
        value, density, _ = lobe.masked(light)
        ours = transformed_density(m, light)
        total += (np.abs(value / albedo - ours) ** 3 / (density + ours + 1e-30)).mean()
    return total


def fitted(lobe: Lobe, albedo: float, mean: np.ndarray, start, is_straight: bool) -> np.ndarray:
    """The three fitted parameters of `matrix`. A lobe seen along the normal is round."""
    frame = np.array([[mean[2], 0, mean[0]], [0, 1, 0], [-mean[0], 0, mean[2]]])
    of_lobe, of_cosine = lobe.directions(SIDE), cosine_directions(SIDE)

    def whole(p):
        return (p[0], p[0], 0.0) if is_straight else tuple(p)

    def cost(p):
        return error(lobe, albedo, matrix(frame, whole(p)), of_lobe, of_cosine)

    first = np.array(start[:1] if is_straight else start)
    simplex = np.vstack([first, first + np.diag(np.maximum(np.abs(first) * 0.2, 0.02))])
    found = minimize(
        cost, first, method="Nelder-Mead", options={"initial_simplex": simplex, "xatol": 1e-5, "fatol": 1e-9}
    )
    return frame, np.array(whole(found.x))


def main() -> None:
    """Fit row by row, starting with a rough surface seen along the normal; each fit starts from its neighbour's
    result.
    """
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=FOLDER)
    out = parser.parse_args().out
    table = np.zeros((ROUGHNESS, ANGLES, 8))
    start_of_row = np.array([1.0, 1.0, 0.0])
    for i in track(range(ROUGHNESS - 1, -1, -1), "roughness"):
        start = start_of_row
        for j in range(ANGLES):
            lobe = Lobe(roughness_of(i), cosine_of(j))
            scale, bias, mean = albedo_and_mean(lobe)
            frame, start = fitted(lobe, scale + bias, mean, start, j == 0)
            if j == 0:
                start_of_row = start
            inverse = np.linalg.inv(matrix(frame, start))
            inverse /= inverse[1, 1]
            table[i, j] = inverse[0, 0], inverse[0, 2], inverse[2, 0], inverse[2, 2], scale, bias, mean[0], mean[2]
    for name, values in (("brdf_table", table.astype(np.float32)), ("edge_table", edge_table())):
        with whole_file(out / f"{name}.npy", np.load) as stream:
            np.save(stream, values)
    print(f"{out}: {table.shape[0]} roughnesses x {table.shape[1]} angles")


if __name__ == "__main__":
    main()
