"""The command line of the method: one module for each command, and what they share."""
