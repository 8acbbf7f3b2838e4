"""What the paper states, and how it compares: readings, claims with verdicts, the ledger of its equations."""
