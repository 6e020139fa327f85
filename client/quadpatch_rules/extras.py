"""Packages of extras that a process looks for before it promises what needs them."""

# To fit networks and export them.
OF_NETWORKS = ("torch", "onnx", "onnxscript")
