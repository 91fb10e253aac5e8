"""YAML as text: nodes with positions, diagnostics, merging, paths."""
