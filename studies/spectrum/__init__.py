"""Overturning spectra: peak tilts over size and intensity, in 3D and by planar analysis."""
