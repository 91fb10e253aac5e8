"""Run the conformance kit from the shell: the checks of `crowdbot.testing`, without pytest."""

from __future__ import annotations

import unittest
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from crowdbot.cli.output.plugin_table import table
from crowdbot.core.registry.plugin_errors import describe_error
from crowdbot.core.registry.registry import Registry
from crowdbot.dsl.spec.component import Component
from crowdbot.errors import CrowdbotError, InputError, UnknownNameError

_BAD = ("failed", "unexpected pass")
#: Checks that only installed plugins can pass, since they search the installation.
_INSTALLED_ONLY = ("check_entry_point_yields_it", "check_card_examples_run")


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """The result of one check of one component.

    Attributes:
        result: ``passed``, ``failed``, ``expected failure``, ``unexpected pass``, ``skipped``.
        reason: the error, or why it is expected or skipped.
        advice: what to do about a failure.
    """

    plugin: str
    kind: str
    check: str
    result: str
    reason: str = ""
    advice: str = ""

    @property
    def bad(self) -> bool:
        """Return True if something has to be fixed."""
        return self.result in _BAD

    def as_dict(self) -> dict[str, str]:
        """Return a dictionary for ``--json``."""
        return asdict(self)


def failed_plugins(registry: Registry, name: str | None) -> list[Result]:
    """Return one failure for each selected plugin that could not be loaded."""
    return [
        Result(plugin=p.name, kind="", check="loading", result="failed", reason=p.failure)
        for p in registry.plugins
        if p.failure and (p.given if name is None else name.partition(".")[0] == p.name)
    ]


def chosen(registry: Registry, name: str | None) -> list[Component[Any]]:
    """Return the components that a name selects; without a name, those of given plugins.

    Raises:
        UnknownNameError: neither a plugin nor a kind has this name.
        InputError: there is nothing to check.
    """
    plugins = {p.name: p for p in registry.plugins}
    if name is None:
        found = [c for p in registry.plugins if p.given for c in p.components]
    elif name in plugins:
        found = list(plugins[name].components)
    else:
        found = [c for p in registry.plugins for c in p.components if c.kind == name]
        if not found:
            known = [*plugins, *(c.kind for p in registry.plugins for c in p.components)]
            raise UnknownNameError("plugin or kind", name, known, registry.why_absent(name))
    if not found:
        raise InputError(f"{name or 'the plugin'} provides no component: there is nothing to check")
    return found


def run_checks(component: Component[Any], registry: Registry) -> Iterator[Result]:
    """Run all checks of one component, one by one.

    Raises:
        InputError: the checks need packages that are not installed.
    """
    owner = registry.owner(component)
    for check in _checks(component):
        name = check.__name__
        expected = _exceptions(component).get(name, "")
        if name in _INSTALLED_ONLY and owner.given:
            result, reason = "skipped", "given by --plugin, not installed"
        else:
            result, reason = _outcome(_bind(check, component, registry), expected)
        advice = _advice(check) if result == "failed" else ""
        yield Result(
            plugin=owner.name,
            kind=component.kind,
            check=name,
            result=result,
            reason=reason,
            advice=advice,
        )


def as_table(results: list[Result], *, passed: bool, all_lines: bool) -> str:
    """Return a row per check, and a last line with counts.

    Args:
        results: results of all checks.
        passed: True to list passed checks.
        all_lines: True to show reasons in full.
    """
    rows = [
        [r.kind or r.plugin, r.check, r.result, _shown(r.reason, all_lines)]
        for r in results
        if passed or r.result != "passed"
    ]
    lines = [table([["component", "check", "result", "reason"], *rows])] if rows else []
    lines += dict.fromkeys(f"{r.check}: {r.advice}" for r in results if r.advice)
    counts = {word: sum(r.result == word for r in results) for word in (*_BAD, "expected failure")}
    problems = [f"{n} {word}" for word, n in counts.items() if n]
    skipped = sum(r.result == "skipped" for r in results)
    problems += [f"{skipped} skipped"] * bool(skipped)
    well = sum(r.result == "passed" for r in results)
    kinds = len({(r.plugin, r.kind) for r in results if r.kind})
    plural = "" if kinds == 1 else "s"
    lines.append(f"{kinds} component{plural}: {', '.join([f'{well} passed', *problems])}")
    return "\n".join(lines)


def _checks(component: Component[Any]) -> tuple[Callable[..., None], ...]:
    try:
        from crowdbot.testing import checks_of
    except ModuleNotFoundError as error:
        raise InputError(
            f"the checks need '{error.name}', which is not installed: "
            "pip install 'crowdbot[testing]'"
        ) from None
    return checks_of(component)


def _bind(
    check: Callable[..., None], component: Component[Any], registry: Registry
) -> Callable[[], None]:
    from crowdbot.testing import bind

    return bind(check, component, registry)


def _exceptions(component: Component[Any]) -> Mapping[str, str]:
    """Return check -> reason for checks that a component declares it cannot pass."""
    declared: Mapping[str, str] = getattr(component, "exceptions", {})
    return declared


def _outcome(check: Callable[[], None], expected: str) -> tuple[str, str]:
    try:
        check()
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        if isinstance(error, unittest.SkipTest) or type(error).__name__ == "Skipped":
            return "skipped", str(error)
        return ("expected failure", expected) if expected else ("failed", _reason(error))
    return ("unexpected pass", f"expected to fail: {expected}") if expected else ("passed", "")


def _reason(error: BaseException) -> str:
    if isinstance(error, AssertionError | CrowdbotError):
        return str(error) or type(error).__name__
    return describe_error(error)


def _shown(text: str, whole: bool) -> str:
    """Return the first line of a text, or all of it on one line."""
    return " ".join((text if whole else text.partition("\n")[0]).split())


def _advice(check: Callable[..., None]) -> str:
    """Return the text after "If this fails," in the docstring of a check."""
    _, found, advice = " ".join((check.__doc__ or "").split()).partition("If this fails, ")
    return advice if found else ""
