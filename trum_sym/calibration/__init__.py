"""Uncertain parameters of a motor fitted to measured data."""
