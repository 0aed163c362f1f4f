"""Files that are read within bounds, and files and folders that are written whole or not at all."""
