"""One box: Valkey, API and workers on this machine, started and watched by one command."""
