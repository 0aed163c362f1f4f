"""What a run leaves behind: an audited dataset, tables, a summary, files."""
