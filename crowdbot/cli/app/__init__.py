"""The typer application: command names, completion, messages for unexpected errors."""
