"""Identifiers: a mesh is named by the sha256 of its bytes, anything else by its time of creation and random bits."""

import secrets
import time

JOB_ID_PATTERN = r"^job_[0-9a-hjkmnp-tv-z]{26}$"
BATCH_ID_PATTERN = r"^bat_[0-9a-hjkmnp-tv-z]{26}$"
WEBHOOK_ID_PATTERN = r"^wh_[0-9a-hjkmnp-tv-z]{26}$"
UPLOAD_ID_PATTERN = r"^upl_[0-9a-hjkmnp-tv-z]{26}$"
MESSAGE_ID_PATTERN = r"^msg_[0-9a-hjkmnp-tv-z]{26}$"
KEY_ID_PATTERN = r"^key_[0-9a-hjkmnp-tv-z]{26}$"
AUDIT_ID_PATTERN = r"^aud_[0-9a-hjkmnp-tv-z]{26}$"
TENANT = r"[a-z0-9][a-z0-9-]{0,62}"
TENANT_PATTERN = rf"^{TENANT}$"
SHA256_PATTERN = r"^[0-9a-f]{64}$"
MODEL_NAME = r"[a-z0-9][a-z0-9._-]{0,63}"

# Crockford's alphabet: no i, l, o, u, so that an id can be read aloud.
_ALPHABET = "0123456789abcdefghjkmnpqrstvwxyz"


def new_job_id() -> str:
    """Return a fresh id of a job."""
    return _new_id("job")


def new_batch_id() -> str:
    """Return a fresh id of a batch."""
    return _new_id("bat")


def new_webhook_id() -> str:
    """Return a fresh id of a subscription."""
    return _new_id("wh")


def new_message_id() -> str:
    """Return a fresh id of a message to a subscriber."""
    return _new_id("msg")


def new_key_id() -> str:
    """Return a fresh id of a key."""
    return _new_id("key")


def new_audit_id() -> str:
    """Return a fresh id of an entry of the audit log."""
    return _new_id("aud")


def new_upload_id() -> str:
    """Return a fresh id of an upload."""
    return _new_id("upl")


def _new_id(kind: str) -> str:
    """Return a fresh id: 48 bits of milliseconds, then 80 random bits, so that ids of a kind sort by age."""
    number = (time.time_ns() // 1_000_000) << 80 | secrets.randbits(80)
    return f"{kind}_" + "".join(_ALPHABET[number >> shift & 31] for shift in range(125, -1, -5))
