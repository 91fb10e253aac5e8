"""Commands that run simulations and score them."""
