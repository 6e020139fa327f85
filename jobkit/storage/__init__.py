"""The object store: local files or S3, incoming bytes, damage and removals."""
