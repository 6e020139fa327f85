"""Rules that the method, the contract, the service and the client apply alike: pure functions, no library."""
