"""The run around the steps: who departs when, stretches of steps, progress, interrupts, compilation."""
