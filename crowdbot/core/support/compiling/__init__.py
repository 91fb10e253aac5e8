"""Compiles hot loops with numba, and keeps the results between processes."""
