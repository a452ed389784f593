"""What interactive figures have in common."""
