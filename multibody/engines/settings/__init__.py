"""Settings of the engines: one file each, with a reason for each value."""
