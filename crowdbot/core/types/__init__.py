"""Types: plain values that several folders share."""
