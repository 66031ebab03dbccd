# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of what stands around glossy objects: where they are taken, how, and what shaders read of them."""
