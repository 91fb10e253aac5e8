"""Tests of bags of ROS."""
