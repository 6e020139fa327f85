"""Keeps the promise of a 202: whatever the database says is due, one leading dispatcher has done."""
