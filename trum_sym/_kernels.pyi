import numpy as np

signatures: dict[str, tuple[str, str]]

def __getattr__(name: str) -> np.ufunc: ...
