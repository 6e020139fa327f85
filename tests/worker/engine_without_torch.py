"""The engine as it is, in a worker that was installed without torch."""

import sys
from pathlib import Path

from quadpatch.inpainters import model_file
from worker.engine import main

# What an import of it meets from now on is an ImportError.
sys.modules["torch"] = None  # type: ignore[assignment]
model_file.SHIPPED_MODELS = next(Path(place) for place in sys.path if Path(place, "general-residual@1.onnx").exists())
run_request = main.run_request
