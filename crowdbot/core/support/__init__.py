"""Support: small tools that know nothing of robots."""
