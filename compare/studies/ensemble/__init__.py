"""Ensembles: peak tilts of many members by several methods, compared as distributions."""
