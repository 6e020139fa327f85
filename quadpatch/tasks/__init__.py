"""What can be done with a mesh file besides filling its holes: from file to file."""
