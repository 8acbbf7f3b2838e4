"""Maxima as a second algebra system: a printer from SymPy's trees, a process to talk to, a script of judges."""
