"""Toward versatility of multi-robot systems (Cherry and Zhang, 2005)."""
