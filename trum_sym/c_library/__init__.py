"""The C library as a folder of sources for a motor, and as a unit for simulation tools (FMI)."""
