"""From SymPy's expressions to C: the list of kernels, their translation by CasADi, headers and the browser's module."""
