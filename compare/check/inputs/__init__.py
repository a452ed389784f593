"""Checks of record files, ground motions and suites."""
