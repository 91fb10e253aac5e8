"""Read recordings: runs, scans, images, commands, and other contents."""
