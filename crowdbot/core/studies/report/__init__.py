"""The report of a study: conditions compared, on one offline page."""
