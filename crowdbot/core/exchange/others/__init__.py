"""Scenes of other simulators: HuNavSim, pedsim_ros, Vadere, JuPedSim, robot_sf, CommonRoad."""
