"""Studies built on the optimiser: Pareto fronts, robust points, speed tables."""
