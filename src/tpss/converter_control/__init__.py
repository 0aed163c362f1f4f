"""Switching converters by their loading against leaving all on: what it saves, and when it pays."""
