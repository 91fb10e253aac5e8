"""Cases of the decision table of fault, and their pictures."""
