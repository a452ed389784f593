"""Measures of agreement: tilt, contact point, turning, energy, agreement time, distributions."""
