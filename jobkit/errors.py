"""Everything that the contract raises on purpose.

::

    JobkitError                     code
    ├── SettingsError               invalid_settings      a setting is wrong, or its name is
    ├── NotFoundError
    │   ├── MeshNotFoundError       mesh_not_found
    │   ├── JobNotFoundError        job_not_found
    │   ├── BatchNotFoundError      batch_not_found
    │   ├── ModelNotFoundError      model_not_found       no such name, version or alias
    │   ├── WebhookNotFoundError    webhook_not_found     no subscription has that id
    │   ├── UploadNotFoundError     upload_not_found      no upload has that id, or it has expired
    │   ├── DeliveryNotFoundError   delivery_not_found    the subscription has no such delivery, or no longer
    │   ├── KeyNotFoundError        key_not_found
    │   ├── TenantNotFoundError     tenant_not_found      no key names that tenant, and nothing was set for it
    │   ├── RuleNotFoundError       rule_not_found        no rule has that name or version
    │   ├── ShadowNotFoundError     shadow_not_found      no candidate runs beside that name
    │   ├── ResultMissingError      result_missing        the job has a result, but the store has lost its file
    │   └── ObjectNotFoundError     object_not_found      the store holds nothing under that key
    ├── ConflictError
    │   ├── MeshRejectedError       mesh_rejected         the analysis found that the file is no usable mesh
    │   ├── MeshNotReadyError       mesh_not_ready        the analysis is still to come
    │   ├── MeshEncodedError        mesh_encoded          a .qpz file has to be decoded before anything else
    │   ├── MeshNotEncodedError     mesh_not_encoded      a mesh that is no .qpz file is to be decoded
    │   ├── UnknownHoleError        unknown_hole          an explicit id names no hole of the mesh
    │   ├── NoTrainingMeshError     no_training_mesh      the filter of a training finds no mesh to learn from
    │   ├── ViewFailedError         view_failed           what a viewer asks for can't be made
    │   ├── NoNetworkWorkerError    no_network_worker     a network is to be fitted, and no running worker can do that
    │   ├── MeshInUseError          mesh_in_use           a mesh is to be deleted while jobs name it
    │   ├── JobNotFinishedError     job_not_finished      a result is asked for, or a deletion, before the job has ended
    │   ├── JobHasNoResultError     job_has_no_result     the job ended without one
    │   ├── JobFinishedError        job_finished          the job ended before it could be changed
    │   ├── NoNetworkError          no_network_registered a CNN job while no network is registered
    │   ├── ModelKindError          model_kind_mismatch   the model is of the other kind or for the other recipe
    │   ├── NameTakenError          name_taken            a model and an alias can't share a name
    │   ├── IdempotencyError        idempotency_conflict  the key came before with another request
    │   ├── UploadOffsetError       upload_offset_conflict   bytes come for another offset than the upload has
    │   ├── UploadNotFinishedError  upload_not_finished   a partial upload that is to be joined is not whole
    │   ├── TooManyWebhooksError    too_many_webhooks     as many subscriptions as there may be
    │   ├── CallbackSecretMissingError  callback_secret_missing  a callback is asked for, and nothing could sign it
    │   ├── BatchNotFinishedError   batch_not_finished    a batch is to be deleted or fetched before it has ended
    │   ├── BatchFinishedError      batch_finished        the batch ended before it could be canceled
    │   ├── BatchSizeError          batch_size            a batch would have no job, or more than it may have
    │   ├── WebhookDisabledError    webhook_disabled      nothing is sent to a subscription that is switched off
    │   ├── OperatorTenantError     operator_tenant       the operator's own tenant can't be disabled
    │   ├── KeyRevokedError         key_revoked           the key was revoked; it can't be rotated
    │   ├── DeliveryPendingError    delivery_pending      a delivery that is still under way can't be repeated
    │   └── HostUnknownError        webhook_host_unknown  the name in a subscription's URL has no address
    ├── AddressRefusedError         webhook_address_refused   nothing is sent to that address
    ├── TlsRequiredError            webhook_needs_tls     nothing is sent there unencrypted
    ├── OverLimitError              over_service_limit    more time or memory than the service grants
    ├── TooLargeError               body_too_large        more bytes than the limit
    ├── UploadFinalError            upload_is_final       bytes come for an upload that joins others
    ├── TooManyUploadsError         too_many_uploads      as many open uploads as there may be
    ├── StoreFullError              store_full            the disk has no room for an upload of that size
    ├── QuotaError
    │   ├── JobQuotaError           quota_jobs            as many jobs of the tenant wait as may
    │   ├── StreamQuotaError        quota_streams         as many event streams of the tenant are open as may be
    │   ├── StorageQuotaError       quota_bytes           the tenant stores as much as it may
    │   └── TenantBusyError         tenant_busy           as many jobs of the tenant run as may: the job waits
    ├── UnusableModelError          unusable_model        the artifact is no model
    ├── OptionsConflictError        options_conflict      options of a job exclude each other
    ├── ObjectDamagedError          object_damaged        the bytes under a key are not those that were stored
    ├── QueueUnavailableError       queue_unavailable     Redis or Valkey does not answer
    ├── DatabaseUnavailableError    database_unavailable  the database does not answer, or is locked for too long
    ├── StoreUnavailableError       store_unavailable     the object store can't be written
    ├── MemoryFullError             memory_full           the job does not fit into the memory of the machine now
    └── StaleAttemptError           stale_attempt         the job has moved on; this attempt may write no more

Beside the tree stand errors that are faults of this code. No handler answers them, so their tracebacks reach the log.

::

    DatabaseError                   the database refused a statement, though it works
    └── RowConflictError            a constraint refused a row; callers that expect this try again

Tested in `tests/test_documents.py`.
"""

from quadpatch_rules.text import printable


class JobkitError(Exception):
    """Base of all errors of the contract; `code` is stable and meant for programs.

    Parameters
    ----------
    message : str
        For people, in one line; it may quote untrusted text, which is escaped.
    """

    code = "jobkit_error"

    def __init__(self, message: str = "") -> None:
        super().__init__(printable(message))


class SettingsError(JobkitError):
    """A setting is wrong, or its name is; its message, for the operator alone, is never cut."""

    code = "invalid_settings"

    def __init__(self, message: str = "") -> None:
        Exception.__init__(self, message)


class NotFoundError(JobkitError):
    """Something was named that is not there."""

    code = "not_found"


class MeshNotFoundError(NotFoundError):
    """No mesh has that id."""

    code = "mesh_not_found"


class JobNotFoundError(NotFoundError):
    """No job has that id."""

    code = "job_not_found"


class BatchNotFoundError(NotFoundError):
    """No batch has that id."""

    code = "batch_not_found"


class ModelNotFoundError(NotFoundError):
    """No model has that name, version or alias."""

    code = "model_not_found"


class KeyNotFoundError(NotFoundError):
    """No key has that id."""

    code = "key_not_found"


class TenantNotFoundError(NotFoundError):
    """No key names that tenant, and nothing was set for it."""

    code = "tenant_not_found"


class ShadowNotFoundError(NotFoundError):
    """No candidate runs beside that name."""

    code = "shadow_not_found"


class RuleNotFoundError(NotFoundError):
    """No rule has that name or version."""

    code = "rule_not_found"


class ResultMissingError(NotFoundError):
    """The job has a result, but the store has lost its file."""

    code = "result_missing"


class ObjectNotFoundError(NotFoundError):
    """The store holds nothing under that key."""

    code = "object_not_found"


class ObjectDamagedError(JobkitError):
    """The bytes under a key are not those that were stored."""

    code = "object_damaged"


class WebhookNotFoundError(NotFoundError):
    """No subscription has that id."""

    code = "webhook_not_found"


class UploadNotFoundError(NotFoundError):
    """No upload has that id, or it has expired."""

    code = "upload_not_found"


class DeliveryNotFoundError(NotFoundError):
    """The subscription has no such delivery, or no longer."""

    code = "delivery_not_found"


class ConflictError(JobkitError):
    """The request is valid, but not possible in the present state."""

    code = "conflict"


class MeshRejectedError(ConflictError):
    """The analysis found that the file is no usable mesh."""

    code = "mesh_rejected"


class MeshNotReadyError(ConflictError):
    """The analysis of the mesh is still to come."""

    code = "mesh_not_ready"


class MeshEncodedError(ConflictError):
    """The mesh is a `.qpz` file, which has to be decoded before anything else."""

    code = "mesh_encoded"


class MeshNotEncodedError(ConflictError):
    """A mesh is to be decoded that is no `.qpz` file."""

    code = "mesh_not_encoded"


class UnknownHoleError(ConflictError):
    """An explicit id names no hole of the mesh."""

    code = "unknown_hole"


class NoTrainingMeshError(ConflictError):
    """The filter of a training finds no mesh to learn from."""

    code = "no_training_mesh"


class ViewFailedError(ConflictError):
    """A view can't be made: of what is no surface, or too large, or a model without anything to draw."""

    code = "view_failed"


class NoNetworkWorkerError(ConflictError):
    """A network is to be fitted, and no running worker can do that."""

    code = "no_network_worker"


class MeshInUseError(ConflictError):
    """A mesh is to be deleted while jobs name it."""

    code = "mesh_in_use"


class JobNotFinishedError(ConflictError):
    """A result is asked for, or the job is to be deleted, before it has ended."""

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


class UploadOffsetError(ConflictError):
    """Bytes come for another offset than the upload has."""

    code = "upload_offset_conflict"


class UploadNotFinishedError(ConflictError):
    """A partial upload that is to be joined is not whole."""

    code = "upload_not_finished"


class TooManyWebhooksError(ConflictError):
    """There are as many subscriptions as there may be."""

    code = "too_many_webhooks"


class CallbackSecretMissingError(ConflictError):
    """A callback is asked for while nothing could sign it."""

    code = "callback_secret_missing"


class BatchNotFinishedError(ConflictError):
    """The batch is to be deleted, or its results are asked for, before it has ended."""

    code = "batch_not_finished"


class BatchFinishedError(ConflictError):
    """The batch ended before it could be canceled."""

    code = "batch_finished"


class BatchSizeError(ConflictError):
    """A batch would have no job, or more than it may have."""

    code = "batch_size"


class WebhookDisabledError(ConflictError):
    """Nothing is sent to a subscription that is switched off."""

    code = "webhook_disabled"


class OperatorTenantError(ConflictError):
    """The operator's own tenant can't be disabled."""

    code = "operator_tenant"


class KeyRevokedError(ConflictError):
    """The key was revoked."""

    code = "key_revoked"


class DeliveryPendingError(ConflictError):
    """A delivery that is still under way can't be repeated."""

    code = "delivery_pending"


class HostUnknownError(ConflictError):
    """The name in a subscription's URL has no address."""

    code = "webhook_host_unknown"


class AddressRefusedError(JobkitError):
    """Nothing is sent to that address: it is not globally routable, and no setting allows it."""

    code = "webhook_address_refused"


class TlsRequiredError(JobkitError):
    """Nothing is sent there unencrypted."""

    code = "webhook_needs_tls"


class OverLimitError(JobkitError):
    """More time or memory than the service grants."""

    code = "over_service_limit"


class TooLargeError(JobkitError):
    """More bytes than the limit."""

    code = "body_too_large"


class UploadFinalError(JobkitError):
    """Bytes come for an upload that joins others."""

    code = "upload_is_final"


class TooManyUploadsError(JobkitError):
    """There are as many open uploads as there may be."""

    code = "too_many_uploads"


class StoreFullError(JobkitError):
    """The disk has no room for an upload of that size."""

    code = "store_full"


class QuotaError(JobkitError):
    """A tenant has what it may have of something: `used` of `limit`."""

    code = "quota_exceeded"

    def __init__(self, message: str = "", limit: int = 0, used: int = 0) -> None:
        super().__init__(message)
        self.limit, self.used = limit, used


class JobQuotaError(QuotaError):
    """As many jobs of the tenant wait as may."""

    code = "quota_jobs"


class StreamQuotaError(QuotaError):
    """As many event streams of the tenant are open as may be."""

    code = "quota_streams"


class StorageQuotaError(QuotaError):
    """The tenant stores as much as it may."""

    code = "quota_bytes"


class TenantBusyError(QuotaError):
    """As many jobs of the tenant run as may: the job waits."""

    code = "tenant_busy"


class UnusableModelError(JobkitError):
    """The artifact is no model."""

    code = "unusable_model"


class OptionsConflictError(JobkitError):
    """Options of a job exclude each other."""

    code = "options_conflict"


class QueueUnavailableError(JobkitError):
    """Redis or Valkey does not answer."""

    code = "queue_unavailable"


class DatabaseUnavailableError(JobkitError):
    """The database does not answer, or stays locked for too long."""

    code = "database_unavailable"


class DatabaseError(Exception):
    """The database refused a statement, though it works; its cause is the error of SQLAlchemy."""


class RowConflictError(DatabaseError):
    """A constraint refused a row: another transaction wrote it first, or a row that it names is missing."""


class StoreUnavailableError(JobkitError):
    """The object store can't be written."""

    code = "store_unavailable"


class MemoryFullError(JobkitError):
    """The job does not fit into the memory of the machine now, and waits."""

    code = "memory_full"


class StaleAttemptError(JobkitError):
    """The job has moved on; this attempt may write no more."""

    code = "stale_attempt"
