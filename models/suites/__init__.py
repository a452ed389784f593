"""Suite files: TOML that states cases, runs and bounds; the suites that ship lie beside."""
