"""Studies: many cases of one scenario, run on one machine or a cluster, kept as one table."""
