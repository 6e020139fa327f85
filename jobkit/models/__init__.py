"""Learned models: registry, headers, proofs, deprecation and deletion."""
