"""Support: small general tools, independent of robots."""
