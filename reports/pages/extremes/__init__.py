"""The page on extremes: one table of verdicts, and what backs them."""
