"""Containment of planner processes by the kernel: files, network, signals, other processes."""
