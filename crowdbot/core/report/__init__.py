"""The report: one offline HTML page about the runs of a suite, with its tables as files."""
