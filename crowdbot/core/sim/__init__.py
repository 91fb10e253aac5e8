"""The only place in core that knows Drake."""
