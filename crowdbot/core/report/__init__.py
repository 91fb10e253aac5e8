"""The report: one offline HTML page about the runs of a suite, with its tables as files."""

from crowdbot.core.report.contents import Contents, Heading, gather
from crowdbot.core.report.page import write_report
from crowdbot.core.report.paper import write_paper

__all__ = ["Contents", "Heading", "gather", "write_paper", "write_report"]
