"""Trained policies as planners: files of weights with their observation and action conventions."""
