"""Which scope of a key each operation needs. An operation that is not named here is refused to all keys.

Tested in `tests/attacks/test_m_tenants.py`.
"""

from collections.abc import Mapping
from http import HTTPStatus

from fastapi import Request

from quadpatch_client.schema import Scope
from service.problems import ProblemError
from service.services import PrincipalDep

OPERATIONS: Mapping[Scope, tuple[str, ...]] = {
    Scope.READ: (
        "list_meshes",
        "get_mesh",
        "get_mesh_content",
        "list_jobs",
        "get_job",
        "list_events",
        "get_result",
        "get_report",
        "get_preview",
        "get_closeups",
        "get_html_report",
        "get_pdf_report",
        "get_mesh_view",
        "get_mesh_outlines",
        "get_job_view",
        "get_model_picture",
        "list_batches",
        "get_batch",
        "list_batch_events",
        "get_batch_figures",
        "get_batch_results",
        "list_trainings",
        "get_training",
        "list_training_events",
        "list_rules",
        "get_rule",
        "list_rule_versions",
        "get_rule_version",
        "dry_run_rule",
        "list_models",
        "get_model",
        "get_model_version",
        "get_model_artifact",
        "list_shadows",
        "get_shadow",
        "list_shadow_runs",
        "list_webhooks",
        "get_webhook",
        "list_deliveries",
        "get_delivery",
        "list_callbacks",
    ),
    Scope.UPLOAD: (
        "upload_mesh",
        "describe_uploads",
        "create_upload",
        "get_upload",
        "continue_upload",
        "delete_upload",
        "delete_mesh",
        "pin_mesh",
        "unpin_mesh",
    ),
    Scope.REPAIR: (
        "create_job",
        "cancel_job",
        "rerun_job",
        "repair",
        "delete_job",
        "pin_job",
        "unpin_job",
        "create_batch",
        "cancel_batch",
        "rerun_batch",
        "delete_batch",
        "renew_callback_secret",
        "save_rule",
        "delete_rule",
        "create_webhook",
        "change_webhook",
        "delete_webhook",
        "test_webhook",
        "rotate_webhook_secret",
        "replay_delivery",
    ),
    Scope.MODELS: (
        "create_training",
        "cancel_training",
        "publish_model",
        "set_alias",
        "delete_alias",
        "deprecate_model_version",
        "restore_model_version",
        "delete_model_version",
    ),
    Scope.ADMIN: (
        "create_key",
        "list_keys",
        "get_key",
        "change_key",
        "rotate_key",
        "revoke_key",
        "list_tenants",
        "get_tenant",
        "change_tenant",
        "set_shadow",
        "clear_shadow",
        "list_audit",
        "metrics",
    ),
}
# Every key may ask what it may do.
OF_ALL = frozenset({"get_limits", "get_version"})
# What sends a mesh and starts a job at once needs both.
ALSO_NEEDS: Mapping[str, Scope] = {"repair": Scope.UPLOAD}
# Of the service itself; `service.auth.PUBLIC_PATHS` names those that need no key.
PUBLIC = frozenset({"healthz", "readyz", "page", "page_asset", "openapi_yaml", "openapi_json", "docs", "docs_asset"})
_SCOPE_OF: Mapping[str, Scope] = {name: scope for scope, names in OPERATIONS.items() for name in names}


def scopes_of(operation: str) -> frozenset[Scope] | None:
    """Return the scopes that an operation needs; None for one that is not known."""
    if operation in PUBLIC | OF_ALL:
        return frozenset()
    scope = _SCOPE_OF.get(operation)
    if scope is None:
        return None
    return frozenset({scope} | ({ALSO_NEEDS[operation]} if operation in ALSO_NEEDS else set()))


async def check_scope(request: Request, principal: PrincipalDep) -> None:
    """Refuse a request whose key does not allow it; raise ProblemError, 403."""
    needed = scopes_of(request.scope["route"].name)
    if needed is None:
        raise ProblemError(HTTPStatus.FORBIDDEN, "scope_missing", "no scope of a key allows this operation")
    missing = sorted(needed - principal.scopes)
    if missing:
        names = " and ".join(missing)
        raise ProblemError(HTTPStatus.FORBIDDEN, "scope_missing", f"the key lacks the scope {names}")
