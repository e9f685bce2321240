"""Page loads that no tab has connected to yet: few, and not for long.

A page is built when it is asked for, and costs some megabytes; a browser then opens a WebSocket
to it.  What only fetches the address (a link preview, a crawler, a loop) never does: of such
visits the oldest go when there are too many, and each after a while.  A tab that comes later than
that loads its page anew by itself.
"""

import asyncio
from typing import Any

__all__ = ["Visits"]

MOST = 16  # that wait; a browser that restores its tabs opens several at once
PATIENCE = 120.0  # s; slow machines and networks take a minute


class Visits:
    """The visits that wait for their tab's connection."""

    def __init__(self, most: int = MOST, patience: float = PATIENCE) -> None:
        self.most, self.patience = most, patience
        self._waiting: dict[str, Any] = {}

    def __len__(self) -> int:
        return len(self._waiting)

    def begin(self, client: Any) -> None:
        """Let a NiceGUI client wait for its tab; called on the server's event loop."""
        self._waiting[client.id] = client
        client.on_connect(lambda: self._waiting.pop(client.id, None))
        client.on_delete(lambda: self._waiting.pop(client.id, None))
        asyncio.get_running_loop().call_later(self.patience, self._drop, client.id)
        while len(self._waiting) > self.most:
            self._drop(next(iter(self._waiting)))

    def _drop(self, name: str) -> None:
        client = self._waiting.pop(name, None)
        if client is not None:
            client.delete()
