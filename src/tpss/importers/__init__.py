"""Scenario parts from files of other formats, which state what was read, left out and assumed."""
