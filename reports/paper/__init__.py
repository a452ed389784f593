"""The figures of the paper, computed again, with what the paper says of them held against the numbers."""
