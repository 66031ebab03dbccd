# SPDX-License-Identifier: GPL-3.0-or-later
"""Groups of the render settings of a scene, each with what it means for `rendering.Settings`.

`properties` has them all in one.
"""
