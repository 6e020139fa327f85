"""`python -m quadpatch_client`, the same as `quadpatch-client`."""

from quadpatch_client.entry import run

if __name__ == "__main__":
    run()
