"""Recording of an engine's steps: kinematics, turning points, forces, energy, rests."""
