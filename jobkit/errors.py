"""Everything that the contract raises on purpose.

::

    JobkitError                     code
    ├── SettingsError               invalid_settings      a setting is wrong, or its name is
    ├── NotFoundError
    │   ├── MeshNotFoundError       mesh_not_found
    │   ├── JobNotFoundError        job_not_found
    │   ├── ModelNotFoundError      model_not_found       no such name, version or alias
    │   └── ObjectNotFoundError     object_not_found      the store holds nothing under that key
    ├── ConflictError
    │   ├── MeshRejectedError       mesh_rejected         the analysis found that the file is no usable mesh
    │   ├── MeshNotReadyError       mesh_not_ready        the analysis is still to come
    │   ├── UnknownHoleError        unknown_hole          an explicit id names no hole of the mesh
    │   ├── JobNotFinishedError     job_not_finished      a result is asked for before there is one
    │   ├── JobHasNoResultError     job_has_no_result     the job ended without one
    │   ├── JobFinishedError        job_finished          the job ended before it could be changed
    │   ├── NoNetworkError          no_network_registered a CNN job while no network is registered
    │   ├── ModelKindError          model_kind_mismatch   the model is of the other kind or for the other recipe
    │   ├── NameTakenError          name_taken            a model and an alias can't share a name
    │   └── IdempotencyError        idempotency_conflict  the key came before with another request
    ├── OverLimitError              over_service_limit    more time or memory than the service grants
    ├── TooLargeError               body_too_large        more bytes than the limit
    ├── UnusableModelError          unusable_model        the artifact is no model
    ├── QueueUnavailableError       queue_unavailable     Redis or Valkey does not answer
    ├── DatabaseUnavailableError    database_unavailable  the database does not answer, or is locked for too long
    ├── StoreUnavailableError       store_unavailable     the object store can't be written
    └── StaleAttemptError           stale_attempt         the job has moved on; this attempt may write no more
"""


class JobkitError(Exception):
    """Base of all errors of the contract; `code` is stable and meant for programs."""

    code = "jobkit_error"


class SettingsError(JobkitError):
    """A setting is wrong, or its name is."""

    code = "invalid_settings"


class NotFoundError(JobkitError):
    """Something was named that is not there."""

    code = "not_found"


class MeshNotFoundError(NotFoundError):
    """No mesh has that id."""

    code = "mesh_not_found"


class JobNotFoundError(NotFoundError):
    """No job has that id."""

    code = "job_not_found"


class ModelNotFoundError(NotFoundError):
    """No model has that name, version or alias."""

    code = "model_not_found"


class ObjectNotFoundError(NotFoundError):
    """The store holds nothing under that key."""

    code = "object_not_found"


class ConflictError(JobkitError):
    """The request is sound, but not in the present state of things."""

    code = "conflict"


class MeshRejectedError(ConflictError):
    """The analysis found that the file is no usable mesh."""

    code = "mesh_rejected"


class MeshNotReadyError(ConflictError):
    """The analysis of the mesh is still to come."""

    code = "mesh_not_ready"


class UnknownHoleError(ConflictError):
    """An explicit id names no hole of the mesh."""

    code = "unknown_hole"


class JobNotFinishedError(ConflictError):
    """A result is asked for before there is one."""

    code = "job_not_finished"


class JobHasNoResultError(ConflictError):
    """The job ended without a result."""

    code = "job_has_no_result"


class JobFinishedError(ConflictError):
    """The job ended before it could be changed."""

    code = "job_finished"


class NoNetworkError(ConflictError):
    """A CNN job while no network is registered."""

    code = "no_network_registered"


class ModelKindError(ConflictError):
    """The model is of the other kind, or was learned for the other recipe."""

    code = "model_kind_mismatch"


class NameTakenError(ConflictError):
    """A model and an alias can't share a name."""

    code = "name_taken"


class IdempotencyError(ConflictError):
    """The idempotency key came before, with another request."""

    code = "idempotency_conflict"


class OverLimitError(JobkitError):
    """More time or memory than the service grants."""

    code = "over_service_limit"


class TooLargeError(JobkitError):
    """More bytes than the limit."""

    code = "body_too_large"


class UnusableModelError(JobkitError):
    """The artifact is no model."""

    code = "unusable_model"


class QueueUnavailableError(JobkitError):
    """Redis or Valkey does not answer."""

    code = "queue_unavailable"


class DatabaseUnavailableError(JobkitError):
    """The database does not answer, or stays locked for too long."""

    code = "database_unavailable"


class StoreUnavailableError(JobkitError):
    """The object store can't be written."""

    code = "store_unavailable"


class StaleAttemptError(JobkitError):
    """The job has moved on; this attempt may write no more."""

    code = "stale_attempt"
