"""Triangle meshes: boundary, holes, normals, welding, smoothing."""
