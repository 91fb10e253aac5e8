"""Typed specs and components: base classes, quantities, assets, unions."""
