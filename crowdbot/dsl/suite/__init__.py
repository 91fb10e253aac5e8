"""Suites: matrix, selection, includes, expansion."""
