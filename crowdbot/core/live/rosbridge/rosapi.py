"""The services below ``/rosapi``, with which clients query topics and services."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from crowdbot.core.live.message import OfferedTopic
from crowdbot.core.live.plain import Ros, ros_type
from crowdbot.core.live.services import Fields, Service, Values
from crowdbot.core.recording import messages as ros
from crowdbot.errors import InputError

NODE = "/crowdbot"
TWIST, JOY = "geometry_msgs/msg/Twist", "sensor_msgs/msg/Joy"


@dataclass
class RosapiWorld:
    """Topics, services and parameters that clients can query.

    Attributes:
        offers: the topics that are published.
        services: services by name; those of rosapi are added.
        parameters: parameters set by clients; ``/use_sim_time`` is true.
        now: simulated time, ns.
        taken: subscribed topics: name -> type.
    """

    ros: Ros
    offers: Sequence[OfferedTopic] = ()
    services: dict[str, Service] = field(default_factory=dict)
    parameters: dict[str, Any] = field(default_factory=lambda: {"/use_sim_time": "true"})
    now: Callable[[], int] = lambda: 0
    taken: Mapping[str, str] = field(default_factory=lambda: {"/cmd_vel": TWIST})

    def topics(self) -> dict[str, str]:
        """Return name -> type, in the spelling of the clients' ROS version."""
        found = {o.topic: ros_type(o.msgtype, self.ros) for o in self.offers}
        return {**{n: ros_type(t, self.ros) for n, t in self.taken.items()}, **found}


def rosapi(world: RosapiWorld) -> dict[str, Service]:
    """Return the services, by name."""
    found: dict[str, Service] = {}

    def add(name: str, request: Fields, response: Fields, call: Callable[[Values], Values]) -> None:
        async def answer(values: Values) -> Values:
            return call(values)

        kind = "rosapi_msgs" if world.ros == 2 else "rosapi"
        title = "".join(part.capitalize() for part in name.split("_"))
        found[f"/rosapi/{name}"] = Service(
            kind=f"{kind}/srv/{title}", request=request, response=response, call=answer
        )

    for group in (_topics, _services, _nodes, _parameters, _details):
        group(world, add)
    return found


Add = Callable[[str, Fields, Fields, Callable[[Values], Values]], None]


def _topics(world: RosapiWorld, add: Add) -> None:
    def both(values: Values) -> Values:
        del values
        topics = world.topics()
        return {"topics": list(topics), "types": list(topics.values())}

    def raw(values: Values) -> Values:
        texts = [ros.definition_text(kind, world.ros) for kind in world.topics().values()]
        return {**both(values), "typedefs_full_text": texts}

    def of_type(values: Values) -> Values:
        type_name = _text(values, "type").replace("/msg/", "/")
        found = [n for n, t in world.topics().items() if t.replace("/msg/", "/") == type_name]
        return {"topics": found}

    lists = {"topics": "string[]", "types": "string[]"}
    add("topics", {}, lists, both)
    add("topics_and_raw_types", {}, {**lists, "typedefs_full_text": "string[]"}, raw)
    add("topics_for_type", {"type": "string"}, {"topics": "string[]"}, of_type)
    add("topic_type", {"topic": "string"}, {"type": "string"},
        lambda v: {"type": world.topics().get(_text(v, "topic"), "")})  # fmt: skip
    add("publishers", {"topic": "string"}, {"publishers": "string[]"},
        lambda v: {"publishers": [NODE] * (_text(v, "topic") in _published(world))})  # fmt: skip
    add("subscribers", {"topic": "string"}, {"subscribers": "string[]"},
        lambda v: {"subscribers": [NODE] * (_text(v, "topic") in world.taken)})  # fmt: skip
    add("interfaces", {}, {"interfaces": "string[]"},
        lambda _: {"interfaces": sorted(set(world.topics().values()))})  # fmt: skip


def _published(world: RosapiWorld) -> set[str]:
    return {o.topic for o in world.offers}


def _services(world: RosapiWorld, add: Add) -> None:
    def kind(name: str) -> str:
        service = world.services.get(name)
        if service is None:
            return ""
        return service.kind.replace("/srv/", "/") if world.ros == 1 else service.kind

    def of_type(values: Values) -> Values:
        type_name = _text(values, "type").replace("/srv/", "/")
        return {
            "services": [n for n in world.services if kind(n).replace("/srv/", "/") == type_name]
        }

    add("services", {}, {"services": "string[]"}, lambda _: {"services": sorted(world.services)})
    add("services_for_type", {"type": "string"}, {"services": "string[]"}, of_type)
    add("service_type", {"service": "string"}, {"type": "string"},
        lambda v: {"type": kind(_text(v, "service"))})  # fmt: skip
    add("service_node", {"service": "string"}, {"node": "string"},
        lambda v: {"node": NODE if _text(v, "service") in world.services else ""})  # fmt: skip
    add("service_host", {"service": "string"}, {"host": "string"},
        lambda v: {"host": "localhost" * (_text(v, "service") in world.services)})  # fmt: skip

    def providers(values: Values) -> Values:
        found = of_type({"type": _text(values, "service")})["services"]
        return {"providers": [NODE] * bool(found)}

    add("service_providers", {"service": "string"}, {"providers": "string[]"}, providers)
    add("action_servers", {}, {"action_servers": "string[]"}, lambda _: {"action_servers": []})


def _nodes(world: RosapiWorld, add: Add) -> None:
    def details(values: Values) -> Values:
        mine = _text(values, "node") == NODE
        return {
            "subscribing": sorted(world.taken) if mine else [],
            "publishing": sorted(_published(world)) if mine else [],
            "services": sorted(world.services) if mine else [],
        }

    def now(values: Values) -> Values:
        del values
        names = ("secs", "nsecs") if world.ros == 1 else ("sec", "nanosec")
        return {"time": dict(zip(names, divmod(world.now(), 10**9), strict=True))}

    lists = dict.fromkeys(("subscribing", "publishing", "services"), "string[]")
    distro = "noetic" if world.ros == 1 else "jazzy"
    add("nodes", {}, {"nodes": "string[]"}, lambda _: {"nodes": [NODE]})
    add("node_details", {"node": "string"}, lists, details)
    add("get_time", {}, {"time": "time" if world.ros == 1 else "builtin_interfaces/Time"}, now)
    add("get_ros_version", {}, {"version": "uint8", "distro": "string"},
        lambda _: {"version": world.ros, "distro": distro})  # fmt: skip


def _parameters(world: RosapiWorld, add: Add) -> None:
    known, most = world.parameters, 1000

    def put(values: Values) -> Values:
        name, value = _text(values, "name"), _text(values, "value")
        if (len(known) >= most and name not in known) or len(name) + len(value) > 65_536:
            raise InputError("there are too many parameters, or they are too long")
        known[name] = value
        return {}

    def delete(values: Values) -> Values:
        known.pop(_text(values, "name"), None)
        return {}

    name, value = {"name": "string"}, {"value": "string"}

    def get(values: Values) -> Values:
        default = _text(values, "default_value") or "null"
        return {"value": known.get(_text(values, "name"), default)}

    def search(values: Values) -> Values:
        end = _text(values, "name")
        return {"global_name": next((k for k in known if k.endswith(end)), "")}

    add("get_param", {**name, "default_value": "string"}, value, get)
    add("set_param", {**name, **value}, {}, put)
    add("delete_param", name, {}, delete)
    add("has_param", name, {"exists": "bool"}, lambda v: {"exists": _text(v, "name") in known})
    add("search_param", name, {"global_name": "string"}, search)
    add("get_param_names", {}, {"names": "string[]"}, lambda _: {"names": sorted(known)})


def _details(world: RosapiWorld, add: Add) -> None:
    typedefs = {"typedefs": "rosapi/TypeDef[]"}

    def service(part: str) -> Callable[[Values], Values]:
        def call(values: Values) -> Values:
            type_name = _text(values, "type").replace("/srv/", "/")
            for each in world.services.values():
                if each.kind.replace("/srv/", "/") == type_name:
                    fields = each.request if part == "Request" else each.response
                    return {"typedefs": [_typedef(f"{type_name}{part}", fields)]}
            raise InputError(f"there is no service type '{type_name}'")

        return call

    add("message_details", {"type": "string"}, typedefs,
        lambda v: {"typedefs": _message_details(_text(v, "type"), world.ros)})  # fmt: skip
    add("service_request_details", {"type": "string"}, typedefs, service("Request"))
    add("service_response_details", {"type": "string"}, typedefs, service("Response"))


def _message_details(kind: str, version: Ros) -> list[Values]:
    """Return the type and all types in it."""
    found: dict[str, Values] = {}
    waiting = [kind]
    while waiting:
        name = waiting.pop(0)
        if name in found:
            continue
        fields = ros.field_types(name)
        if fields is None:
            raise InputError(f"there is no message type '{kind}'")
        found[name] = _typedef(ros_type(name, version), fields)
        waiting += [t.partition("[")[0] for t in fields.values() if "/" in t]
    return list(found.values())


def _typedef(name: str, fields: Fields) -> Values:
    lengths = [_length(kind) for kind in fields.values()]
    return {
        "type": name,
        "fieldnames": list(fields),
        "fieldtypes": [kind.partition("[")[0] for kind in fields.values()],
        "fieldarraylen": lengths,
        "examples": [_example(kind) for kind in fields.values()],
        "constnames": [],
        "constvalues": [],
    }


def _length(kind: str) -> int:
    """Return -1 if not an array, 0 for any length."""
    if "[" not in kind:
        return -1
    inside = kind.partition("[")[2].rstrip("]").lstrip("<=")
    return int(inside) if inside.isdigit() and "<=" not in kind else 0


def _example(kind: str) -> str:
    if "[" in kind:
        return "[]"
    if "/" in kind:
        return "{}"
    return {"string": "", "bool": "False"}.get(kind, "0.0" if kind.startswith("float") else "0")


def _text(values: Values, name: str) -> str:
    value = values.get(name, "")
    if not isinstance(value, str):
        raise InputError(f"'{name}' must be text")
    return value
