"""Reports of results: figures, pages, words in a terminal, and the command line that asks for them."""
