"""The OpenAPI document: built from the routes, completed, handed out."""
