"""Sensors: lidars, range sensors, cameras, odometry, IMU, contact, joysticks."""
