"""The words of crowdbot: specs, YAML, matrices, hashes, diagnostics.

Imports the standard library, pydantic and ruamel.yaml only.
"""
