"""A scenario with each of its outages in turn, ranked by what they do."""
