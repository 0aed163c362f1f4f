"""How much of a run's figures comes from its time step: the run made again with another step."""
