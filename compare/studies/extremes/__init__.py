"""Extremes: every method under extreme conditions, with a verdict on each run and its evidence."""
