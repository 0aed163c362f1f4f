"""Stores of energy, at the line and on board: how much they hold, and what power they take and give."""
