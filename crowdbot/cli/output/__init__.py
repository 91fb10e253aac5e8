"""Tables, lines and pages that commands print."""
