# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of scripts/demo.py that runs inside Blender: reads, converts, lights, frames and renders models."""
