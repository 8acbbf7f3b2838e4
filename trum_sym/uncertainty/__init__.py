"""How uncertain parameters spread a motor's figures, and which of them does it."""
