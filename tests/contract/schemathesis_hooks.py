"""What schemathesis has to know besides the document: how a body of the protocol tus is written."""

import schemathesis

schemathesis.serializer.alias("application/offset+octet-stream", "application/octet-stream")
