"""Results of campaigns: rows of runs, scores and failures, their store and their export."""
