"""Explanations of runs: the decisive moment, in words and as a strip of pictures."""
