"""Many operating points: grids, chunks, stores, and where they are computed."""
