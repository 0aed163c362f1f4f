"""Numerics that know nothing of railways."""
