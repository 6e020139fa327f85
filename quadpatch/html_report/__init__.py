"""The report of a task as one HTML file that stands alone, for people and auditors."""
