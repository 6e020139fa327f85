"""glTF 2.0: reading a scene as one mesh, and handing it back with fills at their nodes."""
