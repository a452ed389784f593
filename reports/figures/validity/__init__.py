"""The pictures of the report on validity."""
