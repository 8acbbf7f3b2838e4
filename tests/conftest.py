from __future__ import annotations

import pytest


@pytest.fixture(scope="session")
def trum60():
    import trum_sym as ts

    return ts.load_motor("trum60")
