"""Certificates of the algebraic core: polynomial identities with their multipliers, replayed in exact fractions."""
