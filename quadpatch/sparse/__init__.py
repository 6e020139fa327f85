"""Sparse coding: dictionaries, masked orthogonal matching pursuit, K-SVD."""
