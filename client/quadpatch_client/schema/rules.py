"""Rules: what is to be done with holes, and what a result has to meet, saved under a name.

Tested in `tests/service/routes/test_rules.py`.
"""

from typing import Annotated

from pydantic import Field

from quadpatch_client.schema.acceptance import Acceptance
from quadpatch_client.schema.base import NAME_PATTERN, REFERENCE_PATTERN, MeshId, Moment, Request, Response
from quadpatch_client.schema.jobs import Plan
from quadpatch_client.schema.methods import AutoMethod, Method
from quadpatch_client.schema.spec import HoleSelection, Text
from quadpatch_rules.option_words import Colours

RuleName = Annotated[str, Field(pattern=NAME_PATTERN, description="Name of a rule.", examples=["castings"])]
RuleReference = Annotated[
    str,
    Field(
        pattern=REFERENCE_PATTERN,
        description="`name@version`, or `name`: its latest version.",
        examples=["castings@2"],
    ),
]


class RuleContent(Request):
    """What a rule says of a job that fills holes; each field as in the spec of a job."""

    description: Text = Field(default="", description="For people.", examples=["castings of line 2"])
    holes: HoleSelection = Field(default_factory=HoleSelection, description="Which holes are filled, and how.")
    method: Method = Field(
        default_factory=lambda: AutoMethod(method="auto"), description="How patches are completed: model and effort."
    )
    colours: Colours = Field(default="auto", description="Colours of new vertices.", examples=["auto"])
    acceptance: Acceptance | None = Field(default=None, description="What its results have to meet.")


class RuleLinks(Response):
    """Paths on this service."""

    self: str = Field(description="This version.", examples=["/v1/rules/castings/versions/2"])
    versions: str = Field(description="All versions.", examples=["/v1/rules/castings/versions"])
    dry_run: str = Field(description="POST here to see what it would do to a mesh.")


class Rule(Response):
    """One version of a rule, which never changes."""

    name: RuleName
    version: int = Field(ge=1, description="Counts up from 1.", examples=[2])
    content: RuleContent = Field(description="What it says.")
    created_at: Moment = Field(description="When it was saved, RFC 3339.")
    links: RuleLinks = Field(description="Paths on this service.")


class RulePage(Response):
    """One page of rules, or of the versions of one."""

    items: list[Rule] = Field(description="Rules by name, each in its latest version; versions, the newest first.")
    next_cursor: str | None = Field(
        default=None, description="Pass as `cursor` to go on; null on the last page.", examples=["castings"]
    )


class RuleTrial(Request):
    """The mesh that a rule is tried on."""

    mesh_id: MeshId


class RulePlan(Response):
    """What a rule would do to a mesh; nothing was started."""

    rule: RuleReference
    plan: Plan = Field(description="What a job would do that names the rule, loop by loop.")
    acceptance: Acceptance | None = Field(default=None, description="What its result would have to meet.")
