"""Scenario parts from the files of others: what was taken, left out and assumed is stated in them."""
