"""The contract between service, workers, training and clients."""
