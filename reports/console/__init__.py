"""The terminal: tables, progress, endings."""
