# SPDX-License-Identifier: GPL-3.0-or-later
"""The samplers of the product with plain surfels as the default, for tests that look at one step at a time: what a test
names is all that its surfels have beside plain ones."""

from splat_addon import sampling

_PLAIN = {**sampling.PLAIN, "fits_blending": False, "fits_planes": False}


def sample_mesh(mesh, **options):
    # as the sampler leaves them: whether they are solid is another fact
    return sample_surface(mesh, **options).surfels


def sample_surface(mesh, **options):
    return sampling.sample_surface(mesh, **(_PLAIN | options))


def sample_block(mesh, number, count, **options):
    return sampling.sample_block(mesh, number, count, **(_PLAIN | options))


def joined_blocks(mesh, blocks, **options):
    return sampling.joined_blocks(mesh, blocks, **(_PLAIN | options))


def deforming_surfels(mesh, **options):
    return sampling.DeformingSurfels(mesh, **(_PLAIN | options))
