"""Holes cut into undamaged surface, whose truth is known: which fill, how much of a model, which error to expect."""
