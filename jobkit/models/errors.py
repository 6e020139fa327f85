"""What stands against the use, the deprecation or the deletion of a model.

::

    ConflictError
    ├── ModelNotProvenError     model_not_proven      no worker has proven the version yet
    ├── ModelRefusedError       model_refused         the proof of the version failed
    ├── ModelDeprecatedError    model_deprecated      an alias is to point to a deprecated version
    ├── ModelInUseError         model_in_use          a job that has not ended, or an alias, needs the version
    ├── AliasInUseError         alias_in_use          jobs that name no model mean the alias
    └── SharedModelError        shared_model          the operator shares it, and alone may change it
"""

from jobkit.errors import ConflictError


class ModelNotProvenError(ConflictError):
    """No worker has proven the version yet."""

    code = "model_not_proven"


class ModelRefusedError(ConflictError):
    """The proof of the version failed."""

    code = "model_refused"


class ModelDeprecatedError(ConflictError):
    """An alias is to point to a deprecated version."""

    code = "model_deprecated"


class ModelInUseError(ConflictError):
    """A job that has not ended, or an alias, needs the version."""

    code = "model_in_use"


class AliasInUseError(ConflictError):
    """Jobs that name no model mean the alias."""

    code = "alias_in_use"


class SharedModelError(ConflictError):
    """The operator shares it, and alone may change it."""

    code = "shared_model"
