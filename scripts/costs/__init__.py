# SPDX-License-Identifier: GPL-3.0-or-later
"""What each feature of a scene costs where it is present: used by measure_features.py."""
