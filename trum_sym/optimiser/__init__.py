"""Operating points under constraints: :func:`trum_sym.optimize`."""
