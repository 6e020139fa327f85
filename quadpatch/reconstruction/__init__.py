"""From completed height maps back to the surface."""
