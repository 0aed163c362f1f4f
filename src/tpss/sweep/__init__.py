"""Studies: many cases of one scenario, run on one computer or a cluster, kept as one table."""
