"""`python -m quadpatch`: the method on files, with no service."""

from quadpatch.cli.app import app

if __name__ == "__main__":
    app(prog_name="python -m quadpatch")
