"""The report: figures, claims and an interactive part as one page."""
