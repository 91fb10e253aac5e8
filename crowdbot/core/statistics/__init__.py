"""Statistics of campaigns: the better planner, by how much, and with what certainty.

Works on `crowdbot.core.results.results.Results` alone: no store, no simulator, no page.
docs/explanation/statistics.md says what is computed and how to read it.
"""

from __future__ import annotations

from crowdbot.core.statistics.atlas import AtlasEntry, atlas
from crowdbot.core.statistics.axes import AxisEffect, DensityLevel, Level
from crowdbot.core.statistics.comparison import Comparison, Verdict
from crowdbot.core.statistics.estimate import OUTCOMES, Counts, Estimate, Outcome
from crowdbot.core.statistics.floors import PRIMARY, FloorCheck, Lead, check_floors
from crowdbot.core.statistics.sample_size import SampleSize, draws_needed, sample_size
from crowdbot.core.statistics.summary import PlannerScore, Summary, headline_names, summarise
from crowdbot.core.statistics.table import Name, Table
from crowdbot.core.statistics.variance import VarianceParts

__all__ = [
    "OUTCOMES",
    "PRIMARY",
    "AtlasEntry",
    "AxisEffect",
    "Comparison",
    "Counts",
    "DensityLevel",
    "Estimate",
    "FloorCheck",
    "Lead",
    "Level",
    "Name",
    "Outcome",
    "PlannerScore",
    "SampleSize",
    "Summary",
    "Table",
    "VarianceParts",
    "Verdict",
    "atlas",
    "check_floors",
    "draws_needed",
    "headline_names",
    "sample_size",
    "summarise",
]
