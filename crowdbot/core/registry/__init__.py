"""The registry: installed plugins and their components."""
