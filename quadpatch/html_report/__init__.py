"""The report of a repair as one HTML file that stands alone, for people and auditors."""
