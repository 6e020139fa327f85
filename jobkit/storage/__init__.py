"""The object store: local files or S3, bytes on their way, damage and removals."""
