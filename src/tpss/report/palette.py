"""Colours of static and interactive figures."""

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#000000")
"""Colours that colour-blind people tell apart (Okabe and Ito)."""

VOLTAGE_SCALE = ((0.0, "#A84300"), (0.35, "#E08214"), (0.7, "#F7CF8B"), (1.0, "#FFFDF5"))
"""From a low voltage, dark, to a high one: in black and white too."""

LEAST_SPAN_KV = 2.0
"""Span of that scale at least, so that a voltage that hardly falls does not look like one that does."""
