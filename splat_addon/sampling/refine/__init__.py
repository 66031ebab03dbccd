# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes the set of samples: merges flat regions, and adds surfels for components that no ray hits."""
