"""Figures of a single run and of a sweep."""
