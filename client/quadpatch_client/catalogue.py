"""What a service keeps besides meshes and jobs: models, rules, keys; and trainings, which make models.

Tested in `tests/integration/test_catalogue_commands.py`.
"""

import hashlib
from collections.abc import Iterator
from datetime import datetime
from typing import TypeVar
from urllib.parse import quote

from pydantic import BaseModel

from quadpatch_client.polling import parse
from quadpatch_client.schema import (
    CallerLimits,
    Key,
    KeyList,
    KeyWithSecret,
    ModelList,
    NewKey,
    NewTraining,
    Rule,
    RuleContent,
    RulePage,
    Scope,
    Training,
)
from quadpatch_client.transport import Transport

M = TypeVar("M", bound=BaseModel)

PAGE = 100


class Catalogue:
    """Calls of the client that are about models, rules and keys.

    Parameters
    ----------
    transport : Transport
    """

    def __init__(self, transport: Transport) -> None:
        self._transport = transport

    def models(self) -> ModelList:
        """Return all models and aliases, fetched page by page; of each model its newest versions."""
        found = ModelList(models=[], aliases=[])
        for page in self._pages("/v1/models", ModelList):
            found.models += page.models
            found.aliases += page.aliases
        return found

    def rules(self) -> list[Rule]:
        """Return all rules by name, each in its latest version."""
        return [rule for page in self._pages("/v1/rules", RulePage) for rule in page.items]

    def rule(self, reference: str) -> Rule:
        """Return a rule by its name, in its latest version, or by `name@version`."""
        name, _, version = reference.partition("@")
        path = f"/v1/rules/{quote(name, safe='')}"
        if version:
            path += f"/versions/{quote(version, safe='')}"
        return parse(Rule, self._transport.request("GET", path))

    def save_rule(self, name: str, content: RuleContent) -> Rule:
        """Save a rule; a name that is there gets its next version."""
        # Fields that are left out are left to the service: it may know others.
        values = content.model_dump(mode="json", exclude_unset=True)
        return parse(Rule, self._transport.request("PUT", f"/v1/rules/{quote(name, safe='')}", json=values))

    def limits(self) -> CallerLimits:
        """Return what limits the caller, and what the service offers."""
        return parse(CallerLimits, self._transport.request("GET", "/v1/limits"))

    def keys(self) -> list[Key]:
        """Return the keys of the tenant, without their secrets; needs the scope `admin`."""
        return parse(KeyList, self._transport.request("GET", "/v1/keys")).items

    def create_key(
        self, name: str, scopes: list[Scope] | None = None, tenant: str | None = None, until: datetime | None = None
    ) -> KeyWithSecret:
        """Make a key; its secret is shown this once.

        Parameters
        ----------
        name : str
            For people.
        scopes : list of Scope, optional
            None: read, upload and repair.
        tenant : str, optional
            None: that of the key that asks.
        until : datetime, optional
            When it is no longer taken, with a zone; None: never.
        """
        wanted = NewKey.model_validate(
            {"name": name, "tenant": tenant, "expires_at": until, "scopes": scopes or _SCOPES}
        )
        response = self._transport.request("POST", "/v1/keys", json=wanted.model_dump(mode="json", exclude_none=True))
        return parse(KeyWithSecret, response)

    def revoke_key(self, key_id: str) -> None:
        """End a key. There is no way back."""
        self._transport.request("DELETE", f"/v1/keys/{key_id}")

    def train(self, wanted: NewTraining) -> Training:
        """Learn a model from uploaded meshes; the same request finds its training again.

        A training is a job of the same id: wait for it as for every job.
        """
        # Fields that are left out are left to the service: it may know others.
        text = wanted.model_dump_json(exclude_unset=True)
        key = f"train-{hashlib.sha256(text.encode()).hexdigest()}"
        headers = {"Idempotency-Key": key, "Content-Type": "application/json"}
        response = self._transport.request(
            "POST", "/v1/trainings", content=lambda: iter([text.encode()]), headers=headers
        )
        return parse(Training, response)

    def _pages(self, path: str, model: type[M]) -> Iterator[M]:
        params = {"limit": str(PAGE)}
        while True:
            page = parse(model, self._transport.request("GET", path, params=params))
            yield page
            cursor = getattr(page, "next_cursor", None)
            if cursor is None:
                return
            params["cursor"] = cursor


_SCOPES = [Scope.READ, Scope.UPLOAD, Scope.REPAIR]
