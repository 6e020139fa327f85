"""Keys of clients: make, list, look at, change, rotate, revoke."""

from http import HTTPStatus
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Path
from starlette.responses import Response

from jobkit.access.keys import Keys
from jobkit.database.tenancy import DEFAULT_TENANT
from quadpatch_client.schema import Key, KeyChanges, KeyList, KeyWithSecret, NewKey
from quadpatch_client.schema.keys import EXAMPLE_KEY_ID
from quadpatch_rules.ids import KEY_ID_PATTERN
from service.idempotency import note_replayed
from service.problems import ProblemError
from service.routes.common import CallerDep, described_header, json_response, linked, problems
from service.services import AllServicesDep, PrincipalDep
from service.strict_validation import StrictRoute

router = APIRouter(tags=["access"], route_class=StrictRoute)
_OPERATIONS = ("get_key", "change_key", "rotate_key", "revoke_key")
_LINKS: dict[str, Any] = {name: linked(name, "$response.body#/id", "key_id") for name in _OPERATIONS}
KeyIdPath = Annotated[str, Path(pattern=KEY_ID_PATTERN, description="Id of a key.", examples=[EXAMPLE_KEY_ID])]


async def _get_keys(services: AllServicesDep, principal: PrincipalDep) -> Keys:
    """Give the keys that the caller may see: the operator all of them, others those of their tenant."""
    is_operator = principal.tenant == DEFAULT_TENANT
    return Keys(services.database if is_operator else services.database.of(principal.tenant))


KeysDep = Annotated[Keys, Depends(_get_keys)]


@router.post(
    "/v1/keys",
    status_code=201,
    response_model=KeyWithSecret,
    responses={
        201: {
            "description": "The key is taken from now on. It is shown this once.",
            "headers": {"Location": described_header("Path of the key.")},
            "links": _LINKS,
        },
        **problems(400, 409, 413, 415),
    },
)
def create_key(keys: KeysDep, caller: CallerDep, new: NewKey) -> Response:
    """Make a key. Keys of the tenant `default` make keys of any tenant, others those of their own.

    Once a key is made, requests without one are refused.
    """
    own = caller.principal.tenant
    if new.tenant not in (None, own) and own != DEFAULT_TENANT:
        raise ProblemError(HTTPStatus.FORBIDDEN, "foreign_tenant", "a key makes keys of its own tenant only")
    key, is_new = keys.create(new, caller.idempotency("create_key", new.model_dump_json()))
    response = json_response(key, HTTPStatus.CREATED, Location=f"/v1/keys/{key.id}", Cache_Control="no-store")
    return note_replayed(response, is_new=is_new)


@router.get("/v1/keys", response_model=KeyList, responses=problems())
def list_keys(keys: KeysDep) -> KeyList:
    """List keys, oldest first, without what clients send."""
    return keys.list_all()


@router.get("/v1/keys/{key_id}", response_model=Key, responses=problems(404))
def get_key(keys: KeysDep, key_id: KeyIdPath) -> Key:
    """Show a key, without what clients send."""
    return keys.get(key_id)


@router.patch("/v1/keys/{key_id}", response_model=Key, responses=problems(400, 404, 413, 415))
def change_key(keys: KeysDep, key_id: KeyIdPath, changes: KeyChanges) -> Key:
    """Set how many requests a key may send within a minute, besides the limit of its tenant.

    Processes of the API know it within some seconds.
    """
    return keys.change(key_id, changes)


@router.post("/v1/keys/{key_id}/rotate", response_model=KeyWithSecret, responses=problems(404, 409))
def rotate_key(keys: KeysDep, caller: CallerDep, key_id: KeyIdPath) -> Response:
    """Get a new key in place of one, which is taken as well for a day."""
    key, is_new = keys.rotate(key_id, caller.idempotency("rotate_key", key_id))
    return note_replayed(json_response(key, Cache_Control="no-store"), is_new=is_new)


@router.delete("/v1/keys/{key_id}", status_code=204, response_class=Response, responses=problems(404))
def revoke_key(keys: KeysDep, key_id: KeyIdPath) -> Response:
    """Take a key no more. It stays in the list, since the audit log names it."""
    keys.revoke(key_id)
    return Response(status_code=HTTPStatus.NO_CONTENT)
