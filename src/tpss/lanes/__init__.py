"""Like cases run at once: eight numbers in one vector of the processor, in the kernels as they are."""
