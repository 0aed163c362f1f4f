"""A result compared with measured series: read, aligned in time, judged."""
