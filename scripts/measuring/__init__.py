# SPDX-License-Identifier: GPL-3.0-or-later
"""What all of scripts/bench and scripts/figures share.

`registry`: which there are. `__main__`: runs one. `timing`, `drawing`: jobs and pictures in turn. `report`: what is
printed and left in a folder. `devices`: where a device can be opened. `models`, `blender_scene`: what is drawn.
"""
