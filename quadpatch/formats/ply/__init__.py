"""PLY: reading any element and property, and handing files back with rows appended."""
