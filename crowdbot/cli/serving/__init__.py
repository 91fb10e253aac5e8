"""Arguments and options of `serve`."""
