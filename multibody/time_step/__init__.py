"""Time steps that are sought, or extrapolated, in place of one that is given."""
