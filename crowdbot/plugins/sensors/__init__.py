"""Sensors."""

from crowdbot.plugins.sensors.lidar2d import LIDAR2D
from crowdbot.plugins.sensors.wheel_odometry import WHEEL_ODOMETRY

COMPONENTS = (LIDAR2D, WHEEL_ODOMETRY)
