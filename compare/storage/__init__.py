"""Files of results: whole or none, tables, fingerprints, provenance."""
