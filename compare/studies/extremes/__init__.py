"""Extremes: every extreme by every method, each verdict with what backs it."""
