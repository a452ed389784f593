"""The page on speed against accuracy: figures, conclusions, tables."""
