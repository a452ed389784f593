"""Pages: words and tables made from stored numbers."""
