"""Read robots and people from bags of ROS: messages, clocks, frames, identities."""
