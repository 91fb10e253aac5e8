"""What campaigns leave behind: rows of runs, scores and failures, their store and their export."""
