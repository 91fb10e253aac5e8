"""Sensors."""

from crowdbot.plugins.sensors.bumper import BUMPER
from crowdbot.plugins.sensors.contact_force import CONTACT_FORCE
from crowdbot.plugins.sensors.imu import IMU
from crowdbot.plugins.sensors.infrared import INFRARED
from crowdbot.plugins.sensors.joystick import JOYSTICK
from crowdbot.plugins.sensors.lidar2d import LIDAR2D
from crowdbot.plugins.sensors.lidar3d import LIDAR3D
from crowdbot.plugins.sensors.people_tracker import PEOPLE_TRACKER
from crowdbot.plugins.sensors.rgbd_camera import RGBD_CAMERA
from crowdbot.plugins.sensors.ultrasound import ULTRASOUND
from crowdbot.plugins.sensors.wheel_odometry import HOLONOMIC_ODOMETRY, WHEEL_ODOMETRY

COMPONENTS = (
    LIDAR2D,
    LIDAR3D,
    ULTRASOUND,
    INFRARED,
    RGBD_CAMERA,
    WHEEL_ODOMETRY,
    HOLONOMIC_ODOMETRY,
    IMU,
    BUMPER,
    CONTACT_FORCE,
    JOYSTICK,
    PEOPLE_TRACKER,
)
