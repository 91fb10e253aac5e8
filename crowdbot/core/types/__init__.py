"""Types: plain values shared by several folders."""
