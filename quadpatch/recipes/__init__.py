"""The stages of a repair in order: the default recipe, and that of the paper."""
