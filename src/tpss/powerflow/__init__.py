"""The load flow of a railway's supply network, solved together with the forces of its trains."""
