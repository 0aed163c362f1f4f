"""Figures of drawings: static ones by matplotlib, interactive ones by plotly."""
