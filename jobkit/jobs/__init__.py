"""Jobs from acceptance to their end: attempts, transitions, events, estimates, limits of time."""
