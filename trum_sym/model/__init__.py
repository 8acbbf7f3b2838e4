"""The motor's model: stator, drive cycle, rotor, and the operating points that they give."""
