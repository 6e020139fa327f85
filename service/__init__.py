"""HTTP over the contract: routes, auth, limits, problem responses. Parses no mesh."""
