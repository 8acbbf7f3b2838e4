import numpy as np

signatures: dict[str, tuple[str, str]]
slope_figures: str
slope_parameters: str
orbit_flags: str
made_of: str

def __getattr__(name: str) -> np.ufunc: ...
