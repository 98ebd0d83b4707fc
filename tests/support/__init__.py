"""What tests share: oracles, data, and functions that children are asked for."""
