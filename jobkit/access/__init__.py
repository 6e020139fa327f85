"""Who may do what: keys of clients, and the log of what they did."""
