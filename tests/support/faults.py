"""What errors say."""

import pytest


def fault(error, action):
    """Return the one sentence of the error that an action must raise."""
    with pytest.raises(error) as caught:
        action()
    message = str(caught.value)
    assert "\n" not in message
    assert message.endswith(".")
    return message
