"""Records of ground motions: their files, their units, and those that ship or can be installed."""
