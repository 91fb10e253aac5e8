"""Commands that show scenarios, recordings and runs."""
