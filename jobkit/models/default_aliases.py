"""The aliases that stand for the models of specs that name none, and the kind that each of them means."""

from quadpatch_client.schema import (
    DEFAULT_MODEL,
    DEFAULT_NETWORK,
    DEFAULT_PAPER_MODEL,
    DEFAULT_PAPER_NETWORK,
    ModelKind,
)

DEFAULT_KINDS: dict[str, ModelKind] = {
    DEFAULT_MODEL: "dictionary",
    DEFAULT_NETWORK: "autoencoder",
    DEFAULT_PAPER_MODEL: "dictionary",
    DEFAULT_PAPER_NETWORK: "autoencoder",
}
