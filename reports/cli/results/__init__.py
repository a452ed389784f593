"""Commands that show what other commands wrote, or a run as it moves."""
