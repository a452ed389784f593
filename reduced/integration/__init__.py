"""Time integration of the reduced models through a record: steps, uplift, rest and endings."""
