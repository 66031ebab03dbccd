# SPDX-License-Identifier: GPL-3.0-or-later
"""What changes the set of samples: merging to fewer, and surfels for components that no ray meets."""
