# SPDX-License-Identifier: GPL-3.0-or-later
"""The size and weight of merged surfels: they are drawn smaller where the pixel's filter blends them, and count about
as much as the samples that they stand for."""

from __future__ import annotations

from ...hierarchy.nodes import LEAST_SHOWN, MERGED_WEIGHT
from ..passes.decisions import merging
from ..plan.graph import Part
from ..plan.hosts import SPLAT_HOSTS, Host
from ..plan.planning import any_of

CONSTANTS = {"MERGED_WEIGHT": MERGED_WEIGHT, "LEAST_SHOWN": LEAST_SHOWN}


def is_present(planning) -> bool:
    return bool(planning.find(merging)) or any_of(lambda i: i.is_merged, planning.surfels)


def parts(planning, p):
    if p.host in (*SPLAT_HOSTS, Host.VISIBILITY, Host.LIT_SPLATS):
        yield Part("merged_size", only="splats" if p.host == Host.VISIBILITY else "")
