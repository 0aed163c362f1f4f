"""Line constants: impedances and capacitances of a line from where its conductors hang and lie.

A file describes the conductors (`geometry`); `formulas` has what is computed of them, in numpy alone;
`constants` puts both together, and `catenary` makes of it what a scenario takes.
"""
