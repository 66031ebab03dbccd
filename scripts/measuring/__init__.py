# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by all of scripts/bench and scripts/figures.

`registry` lists the modules, and `__main__` runs one. `timing` and `drawing` run jobs and pictures in turn. `report`
writes what is printed and left in a folder. `devices` finds out where a device can be opened. `models` and
`blender_scene` provide scenes.
"""
