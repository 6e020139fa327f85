"""Pictures of a finished repair, before and after, drawn by casting rays."""
