"""Denoising: moving vertices back onto the surface that was scanned."""
