"""The page on which a participant goes through a study, and its server on this machine."""
