"""3MF: reading what a package builds, and handing it back with fills in their objects."""
