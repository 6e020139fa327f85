"""URLs that messages are sent to.

Tested in `tests/jobkit/webhooks/test_subscriptions.py`.
"""

from typing import Annotated

from pydantic import Field

_LABEL = r"[A-Za-z0-9]([A-Za-z0-9_-]{0,61}[A-Za-z0-9])?"
_PORT = r":([1-9][0-9]{0,3}|[1-5][0-9]{4}|6[0-4][0-9]{3}|65[0-4][0-9]{2}|655[0-2][0-9]|6553[0-5])"
_STEP = r"([A-Za-z0-9._~!$&'()*+,;=:@/{}-]|%[0-9A-Fa-f]{{2}})*"
# Without a user, a password or a fragment: none of them would be sent.
URL_PATTERN = (
    rf"^https?://({_LABEL}(\.{_LABEL})*|\[[0-9A-Fa-f:.]{{2,45}}\])({_PORT})?"
    rf"(/{_STEP.format('')})?(\?{_STEP.format('?')})?$"
)

WebhookUrl = Annotated[
    str,
    Field(
        pattern=URL_PATTERN,
        max_length=2048,
        description="Where to send messages: https, and an address that the whole internet can reach, unless the "
        "operator allows others. Redirects are not followed.",
        examples=["https://mes.example.com/hooks/quadpatch"],
    ),
]
