"""What breaks first: every extreme by every method, each verdict with what backs it."""
