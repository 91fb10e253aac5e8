"""People of data sets: TrajNet++, ETH and UCY."""
