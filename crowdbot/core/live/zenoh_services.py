"""ROS 2 services on zenoh: a query is a request, its reply the response (rmw_zenoh)."""

from __future__ import annotations

import asyncio
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Any

import crowdbot.core.live.ros2_keys as ros2_keys
from crowdbot.core.live.service_types import ServiceType, service_type
from crowdbot.core.live.services import Service, Values
from crowdbot.errors import InputError

#: Largest number of parallel calls; step calls wait until the steps are taken.
_MOST_CALLS = 8


class ZenohServices:
    """Replies to queries in separate threads."""

    def __init__(self, session: Any) -> None:
        """Prepare the services. ``session``: a zenoh session."""
        self._session = session
        self._threads = ThreadPoolExecutor(_MOST_CALLS, thread_name_prefix="zenoh-service")
        self._kept: list[Any] = []

    def serve(
        self, name: str, service: Service, domain: int, distro: ros2_keys.Distro
    ) -> ros2_keys.Ros2Topic:
        """Announce and serve one service.

        Returns:
            Its ROS 2 name.
        """
        types = service_type(service)
        topic = ros2_keys.Ros2Topic(
            name, service.kind, ros2_keys.service_hash_in(types.hash, distro)
        )

        def on_query(query: Any) -> None:
            with suppress(RuntimeError):  # already closed
                self._threads.submit(self._answer, query, service, types)

        self._kept.append(
            self._session.declare_queryable(topic.key(domain), on_query, complete=True)
        )
        return topic

    def close(self) -> None:
        """Stop replying."""
        self._threads.shutdown(wait=False, cancel_futures=True)

    def _answer(self, query: Any, service: Service, types: ServiceType) -> None:
        with query:
            attached = None if query.attachment is None else query.attachment.to_bytes()
            known = None if attached is None else ros2_keys.read_attachment(attached)
            if known is None:
                query.reply_err(b"a request of rmw_zenoh has an attachment of 33 bytes")
                return
            number, client = known
            data = b"" if query.payload is None else query.payload.to_bytes()
            try:
                answer = types.response(asyncio.run(_called(service, types.request(data))))
            except InputError as error:
                query.reply_err(str(error).encode())
                return
            query.reply(
                query.key_expr,
                answer,
                attachment=ros2_keys.attachment(number, time.time_ns(), client),
            )


async def _called(service: Service, values: Values) -> Values:
    try:
        return await service.call(values)
    except InputError as error:
        if "success" not in service.response:
            raise
        return {"success": False, "message": str(error)}
