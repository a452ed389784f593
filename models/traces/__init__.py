"""The motion of a cylinder, whoever computed or measured it."""
