"""Commands that write data for other programs, or fit crowds to data."""
