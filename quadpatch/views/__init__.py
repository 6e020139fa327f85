"""What a viewer in the browser shows: reduced surfaces as GLB, outlines of holes, pictures of models."""
