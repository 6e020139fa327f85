"""The local stack: Valkey, dispatcher, API and workers on this machine, started and watched by one command."""
