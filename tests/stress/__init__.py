"""Processes that are killed, and machine code that is loaded: the same bits."""
