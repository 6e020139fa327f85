"""What is delivered around the code: the locks of the image, its bill of materials, manifests, alerts."""
