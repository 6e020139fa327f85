"""onnxruntime with its telemetry off: every module takes the library from here.

The library reads the variable once, when it is loaded. Without it, an import looks up a host of its vendor and writes
a database into the cache folder of the user.
"""

import os

TELEMETRY_OFF = "ORT_DISABLE_TELEMETRY"

# The one thing that this module does at import: later is too late.
os.environ[TELEMETRY_OFF] = "1"

import onnxruntime as ort  # noqa: E402  only once the variable is set

__all__ = ["TELEMETRY_OFF", "ort"]
