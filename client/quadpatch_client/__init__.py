"""What a station installs: the SDK and the command line. Knows nothing of this project but its wire schema."""
