"""First principles in SymPy: every formula of the project is typed here, once."""
