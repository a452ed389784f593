"""Ensembles: peak tilts of many members, for what lies beyond the agreement of traces."""
