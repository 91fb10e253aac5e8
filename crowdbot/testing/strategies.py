"""Hypothesis strategies for valid random specs of a component. Needs hypothesis."""

from __future__ import annotations

from typing import Annotated, Any, Literal, get_origin

from hypothesis import reject
from hypothesis import strategies as st
from pydantic import ValidationError
from pydantic.fields import FieldInfo

from crowdbot.core.registry.registry import Registry
from crowdbot.dsl.spec.component import Component
from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.testing.around import around

#: Largest number of fields that differ from an example.
_MOST = 3


def specs(
    component: Component[Any], registry: Registry | None = None
) -> st.SearchStrategy[ComponentSpec]:
    """Return a strategy for valid specs: an example with up to three changed fields.

    Numbers stay within their bounds; specs refused by a validator are not drawn.
    """
    model = around(component, registry).spec_model(component.category, component.kind)
    return _specs(model, component.kind, list(component.examples))


@st.composite
def _specs(
    draw: st.DrawFn, model: type[ComponentSpec], kind: str, examples: list[Any]
) -> ComponentSpec:
    words = {**draw(st.sampled_from(examples)), "kind": kind}
    drawable = {n: f for n, f in model.model_fields.items() if n != "kind" and _is_plain(f)}
    chosen = []
    if drawable:
        names = st.sampled_from(sorted(drawable))
        chosen = draw(st.lists(names, max_size=_MOST, unique=True))
    for name in chosen:
        words[name] = draw(_values(drawable[name]))
    try:
        return model.model_validate(words)
    except ValidationError:
        reject()


def _is_plain(field: FieldInfo) -> bool:
    """Return True if a field holds only a number, a text or a boolean."""
    annotation: Any = field.annotation
    return annotation in (bool, float, int) or get_origin(annotation) is Literal


def _values(field: FieldInfo) -> st.SearchStrategy[Any]:
    annotation: Any = field.annotation
    if annotation is float:
        return _floats(field)
    bounds = tuple(m for m in field.metadata if type(m).__module__ == "annotated_types")
    bounded: Any = Annotated[(annotation, *bounds)] if bounds else annotation
    return st.from_type(bounded)


def _floats(field: FieldInfo) -> st.SearchStrategy[float]:
    found: dict[str, Any] = {}
    for bound in field.metadata:
        for name, key in (("gt", "min_value"), ("ge", "min_value"), ("lt", "max_value"),
                          ("le", "max_value")):  # fmt: skip
            value = getattr(bound, name, None)
            if value is not None:
                found[key] = value
                found[f"exclude_{key[:3]}"] = name in ("gt", "lt")
    return st.floats(allow_nan=False, allow_infinity=False, **found)
