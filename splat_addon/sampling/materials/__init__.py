# SPDX-License-Identifier: GPL-3.0-or-later
"""What a surface looks like: constants, textures, vertex colours and shading graphs, evaluated at places on it."""
