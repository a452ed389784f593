"""What a folder of results holds, from its files alone."""
