"""Networks that are trained here; the one part of the method that needs torch."""
