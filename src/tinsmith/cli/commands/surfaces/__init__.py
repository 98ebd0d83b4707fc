"""Commands that make, change, check and show surfaces."""
