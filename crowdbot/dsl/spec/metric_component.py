"""Declaration of metrics: `declare_metric`, and the resulting `MetricComponent`."""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeVar, Unpack, get_args

from crowdbot.dsl.spec.component import Component, S_co
from crowdbot.dsl.spec.component_specs import MetricSpec
from crowdbot.dsl.spec.metric_invariants import InvariantOptions, MetricInvariants
from crowdbot.dsl.spec.spec import ComponentSpec
from crowdbot.errors import PluginError, did_you_mean, nearest

#: Which values are better; ``reference``: those nearer to the reference run's.
Better = Literal["higher", "lower", "reference", "none"]

_S = TypeVar("_S", bound=MetricSpec)


@dataclass(frozen=True, slots=True, kw_only=True)
class MetricVariant:
    """One number of a metric: its unit, direction and invariants.

    Attributes:
        rate_over: variant by which the rate is divided, such as the distance for contacts per
            distance. Many runs are then pooled: all contacts over the total distance. Empty: by the
            mean.
    """

    unit: str
    better: Better
    invariants: MetricInvariants = field(default_factory=MetricInvariants)
    rate_over: str = ""


class VariantOptions(InvariantOptions, total=False):
    """Differences of one variant from its metric, as arguments of `declare_metric`."""

    unit: str
    better: Better
    rate_over: str


@dataclass(frozen=True, slots=True, kw_only=True)
class MetricComponent(Component[S_co]):
    """A metric: a component, and properties shared by all its scores; see `declare_metric`.

    Attributes:
        symbol: short form of its name, such as ``T_nm``.
        score_category: category of its scores, such as ``motion``.
        unit, better: defaults for its variants.
        variants: name -> variant, in the order in which they are scored.
        signals: names of the signals that it reads; the conformance kit's runs contain them.
        about_person: True if it is about the person of a task; see `declare_metric`.

    Raises:
        PluginError: a text is empty, there is no variant, or no such direction.
    """

    symbol: str
    score_category: str
    unit: str
    better: Better
    variants: Mapping[str, MetricVariant]
    signals: tuple[str, ...] = ()
    about_person: bool = False

    def __post_init__(self) -> None:
        texts = {"symbol": self.symbol, "category": self.score_category}
        texts |= {f"unit of '{name}'": v.unit for name, v in self.variants.items()}
        for name, text in {**texts, "unit": self.unit}.items():
            if not text.strip():
                raise _wrong(self.spec, f"{name} is empty")
        if not self.variants:
            raise _wrong(self.spec, "it has no variant")
        for name, variant in self.variants.items():
            if variant.rate_over and variant.rate_over not in self.variants:
                hint = did_you_mean(nearest(variant.rate_over, self.variants))
                text = f"'{name}' is a rate over '{variant.rate_over}', which is not a variant"
                raise _wrong(self.spec, f"{text}{hint}")
        for better in (self.better, *(v.better for v in self.variants.values())):
            if better not in get_args(Better):
                known = ", ".join(get_args(Better))
                raise _wrong(self.spec, f"better is '{better}', not one of {known}")


def declare_metric(
    spec: type[_S],
    *,
    symbol: str,
    unit: str,
    better: Better,
    category: str,
    variants: Sequence[str] | Mapping[str, VariantOptions] = ("corrected",),
    signals: Sequence[str] = (),
    about_person: bool = False,
    build: str = "",
    summary: str = "",
    spec_version: int = 1,
    examples: Sequence[Mapping[str, Any]] = ({},),
    experimental: bool = False,
    successor: str = "",
    card: str = "",
    exceptions: Mapping[str, str] | None = None,
    **invariants: Unpack[InvariantOptions],
) -> MetricComponent[_S]:
    """Declare a metric; arguments with defaults may be left out.

    Args:
        spec: its parameters; the first line of the docstring describes the metric.
        symbol: short form of its name, such as ``T_nm``.
        unit: unit of its values; ``"1"`` for a plain number.
        better: which values are better.
        category: category of its scores, such as ``motion``.
        variants: names of the variants in the order in which they are scored; or name ->
            differences: ``unit``, ``better``, ``rate_over`` (see `MetricVariant`) and fields of
            `MetricInvariants`.
        signals: names of the signals that it reads.
        about_person: True if it is about the person of a task: it is scored only in runs whose task
            is about a person, and where it is named.
        build: ``"package.module:function"``. Default: beside the spec; that of
            ``package.motion:SpeedSpec`` is ``package.motion_build:Speed``.
        summary: one line. Default: the symbol and the first line of the spec's docstring.
        spec_version, examples, experimental, successor, card, exceptions: as in
            `crowdbot.plugin.Component`.
        invariants: fields of `MetricInvariants` for all variants.

    Raises:
        PluginError: a text is empty, there is no variant, no such direction or option, or an
            invariant that no value can satisfy.
    """
    changes = _by_name(spec, variants)
    common: VariantOptions = {"unit": unit, "better": better, "rate_over": "", **invariants}
    return MetricComponent(
        spec=spec,
        build=build or f"{spec.__module__}_build:{spec.__name__.removesuffix('Spec')}",
        summary=summary or _summary(spec, symbol),
        spec_version=spec_version,
        examples=tuple(examples),
        experimental=experimental,
        successor=successor,
        card=card,
        exceptions=exceptions or {},
        symbol=symbol,
        score_category=category,
        unit=unit,
        better=better,
        variants={name: _variant(spec, name, {**common, **v}) for name, v in changes.items()},
        signals=tuple(signals),
        about_person=about_person,
    )


def _by_name(
    spec: type[MetricSpec], variants: Sequence[str] | Mapping[str, VariantOptions]
) -> Mapping[str, VariantOptions]:
    """Return name -> differences of this variant."""
    if isinstance(variants, Mapping):
        return variants
    if isinstance(variants, str):
        raise _wrong(spec, f"variants is '{variants}', not a list of names")
    if len(set(variants)) < len(variants):
        raise _wrong(spec, f"a variant is listed twice: {', '.join(variants)}")
    return {name: {} for name in variants}


def _variant(spec: type[MetricSpec], name: str, options: VariantOptions) -> MetricVariant:
    known = list(VariantOptions.__annotations__)
    for option in options:
        if option not in known:
            hint = did_you_mean(nearest(option, known))
            raise _wrong(spec, f"variant '{name}' has no option '{option}'{hint}")
    invariants: dict[str, Any] = {**options}
    unit, better = invariants.pop("unit"), invariants.pop("better")
    rate_over = invariants.pop("rate_over")
    try:
        return MetricVariant(
            unit=unit,
            better=better,
            invariants=MetricInvariants(**invariants),
            rate_over=rate_over,
        )
    except ValueError as error:
        raise _wrong(spec, f"variant '{name}': {error}") from error


def _summary(spec: type[MetricSpec], symbol: str) -> str:
    """Return the default summary: the symbol, and the first line of the spec's docstring."""
    line = inspect.cleandoc(spec.__doc__ or "").partition("\n")[0].rstrip(".")
    starts_with_acronym = line[:2].isupper()
    text = line if starts_with_acronym else line[:1].lower() + line[1:]
    return f"{symbol}: {text}" if text else symbol  # python -OO has no docstrings


def _wrong(spec: type[ComponentSpec], problem: str) -> PluginError:
    return PluginError(f"metric {getattr(spec, '__name__', spec)}: {problem}")
