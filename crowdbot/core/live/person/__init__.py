"""A person in a run, through a page in the browser: driving a robot, or walking in the crowd."""
