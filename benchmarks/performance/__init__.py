"""Seconds and memory of whole processes: ours and peers, on generated scans."""
