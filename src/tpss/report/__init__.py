"""What a reader is shown of results: figures."""
