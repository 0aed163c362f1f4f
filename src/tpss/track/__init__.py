"""The track: which places the routes of trains lead over."""
