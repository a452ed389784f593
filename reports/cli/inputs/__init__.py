"""From options to a problem and a method."""
