"""Tractive effort: one file a way to describe what a train's motors give at most."""
