"""What feeds the network: one file a kind of source, with its parameters and its law."""
