"""The cost function of Dutra et al.: time to and distance of closest approach."""
