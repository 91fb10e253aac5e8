"""The rosbridge protocol, version 2, without ROS: JSON and CBOR over websockets."""
