"""Studies with people: who drives in which condition when, what is asked, what was found."""
