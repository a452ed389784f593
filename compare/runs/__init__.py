"""What is to be run, where it runs, and the finished runs that are kept."""
