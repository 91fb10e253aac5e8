"""Commands to begin with: the machine, the documents, scenarios that are checked."""
