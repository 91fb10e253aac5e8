"""Installed packages that do everything wrong: each is disabled alone, and says why."""

from __future__ import annotations

from importlib import metadata
from pathlib import Path
from typing import Any

import pytest

from tests.cli.plugin_packages import HEAD, Site, planner

pytestmark = pytest.mark.slow

SPEC = """
class Spec(PlannerSpec):
    kind: {kind}
{body}

@hookimpl
def crowdbot_components():
    return {{"planner": [Component(spec=Spec, build="a:b", summary="x")]}}
"""


def returning(text: str) -> str:
    """A module whose hook returns something."""
    return f"{HEAD}\n@hookimpl\ndef crowdbot_components():\n    return {text}\n"


def spec(kind: str, body: str = "") -> str:
    return HEAD + SPEC.format(kind=kind, body=body)


VERSION = metadata.version("crowdbot")
#: Name -> module, and what the listing says of it.
BROKEN = {
    "missing": ("import no_such_module", "ModuleNotFoundError: No module named 'no_such_module'"),
    "syntax": ("def (", "SyntaxError: invalid syntax"),
    "leaves": ("import sys; sys.exit(7)", "SystemExit: 7"),
    "own_way": ("class Odd(BaseException): pass\nraise Odd('why not')", "Odd: why not"),
    "future": (planner("future.go").replace("API = 1", "API = 2"),
               "crowdbot-future 0.3 was written for plugin API 2; this crowdbot "
               f"{VERSION} speaks 1"),
    "past": (planner("past.go").replace("API = 1", "API = 0"), "written for plugin API 0"),
    "text_api": (planner("text_api.go").replace("API = 1", "API = '1'"),
                 "CROWDBOT_API must be a whole number such as 1, not '1'"),
    "true_api": (planner("true_api.go").replace("API = 1", "API = True"), "not True"),
    "misspelt": (planner("misspelt.go").replace("def crowdbot_comp", "def crowdbot_conp"),
                 "unknown hook 'crowdbot_conponents'; did you mean 'crowdbot_components'?"),
    "unmarked": (planner("unmarked.go").replace("@hookimpl\n", ""),
                 "'crowdbot_components' is not marked as a hook: write @hookimpl above it"),
    "empty": (HEAD, "has no hook"),
    "argument": (returning("{}").replace("components()", "components(registry)"), "'registry'"),
    "raises": (returning("1 / 0"), "ZeroDivisionError"),
    "nothing": (returning("None"), "crowdbot_components returned None; a table is wanted"),
    "list": (returning("[3]"), "crowdbot_components returned [3] (list); a table is wanted"),
    "no_category": (returning("{'planers': []}"),
                    "there is no category 'planers'; did you mean 'planner'?"),
    "no_list": (returning("{'planner': 'a:B'}"), "planner: 'a:B' (str); a list is wanted"),
    "number": (returning("{'planner': [3]}"),
               "planner: 3 (int); a Component is wanted, or \"package.module:NAME\""),
    "no_reference": (returning("{'planner': ['a.b']}"), "planner: 'a.b' is not a reference"),
    "no_module": (returning("{'planner': ['nowhere:GO']}"),
                  "planner: ModuleNotFoundError: No module named 'nowhere'"),
    "no_name": (returning("{'planner': ['plugin_no_name:Component']}"),
                "planner: 'plugin_no_name:Component': plugin_no_name has no component"),
    "bare": (planner("dwa"), "kind 'dwa' must start with 'bare.'"),
    "thief": (planner("good.go"), "kind 'good.go' must start with 'thief.'"),
    "blank": (planner("blank."), "letters, digits, _ and - only after the dot"),
    "category": (planner("category.go").replace('{"planner"', '{"robot"'),
                 "category.go is listed as a robot, but it is a planner"),
    "no_literal": (spec("str = 'no_literal.go'"), "Spec: kind must be one literal"),
    "no_text": (spec("Literal[3] = 3"), "Spec: kind must be one literal"),
    "two_kinds": (spec("Literal['two_kinds.a', 'two_kinds.b'] = 'two_kinds.a'"), "one literal"),
    "no_spec": (returning("{'planner': [Component(spec=int, build='a:b', summary='')]}"),
                "is not a spec"),
    "unknown_type": (spec("Literal['unknown_type.go'] = 'unknown_type.go'", "    x: 'Nowhere'"),
                     "unknown_type.go: Spec cannot be built"),
    "odd_type": (spec("Literal['odd_type.go'] = 'odd_type.go'", "    x: object() = 1"),
                 "odd_type.go: Spec cannot be built"),
    "union": (spec("Literal['union.go'] = 'union.go'",
                   "    @field_validator('kind', mode='before')\n    @classmethod\n"
                   "    def _any(cls, value: Any) -> Any: return value"),
              "union.go: Spec cannot be built"),
    "no_build": (planner("no_build.go", build="nowhere"), "build must be text"),
    "twice": (planner("twice.go").replace("[PLANNER]", "[PLANNER, PLANNER]"),
              "E301 planner 'twice.go' is provided twice"),
    "no_card": (HEAD + "from crowdbot.plugin import MetricSpec\n"
                "class Spec(MetricSpec):\n    kind: Literal['no_card.m'] = 'no_card.m'\n"
                "@hookimpl\ndef crowdbot_components():\n"
                "    return {'metric': [Component(spec=Spec, build='a:b', summary='')]}",
                "metric 'no_card.m' is not a MetricComponent; use declare_metric"),
    "folder": (HEAD + "@hookimpl\ndef crowdbot_scenario_dirs():\n    return ['suites']",
               "crowdbot_scenario_dirs returned 'suites' (str)"),
}  # fmt: skip


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Site:
    """All of them at once, a good one in between, and collisions."""
    site = Site(tmp_path_factory.mktemp("site"))
    for name, (text, _) in BROKEN.items():
        site.install(name, text)
    site.install("good", "import sys\nprint('hello from import')\n" + planner("good.go"))
    site.install("dashed", planner("dashed.go"), entry="Dashed-Name")
    site.install("first", planner("shared.go"), entry="shared")
    site.install("second", planner("shared.go"), entry="shared", version="1.0")
    site.install("usurper", planner("dwa"), entry="builtin")
    site.declare("crowdbot-nowhere", "nowhere = no_such_plugin")
    site.declare("crowdbot-odd-value", "odd_value = not a module!")
    return site


@pytest.fixture(scope="module")
def listed(site: Site) -> dict[str, list[dict[str, Any]]]:
    return site.plugins()


@pytest.mark.parametrize("name", BROKEN)
def test_each_is_disabled_and_says_why(name: str, listed: dict[str, list[dict[str, Any]]]) -> None:
    (plugin,) = listed[name]
    assert plugin["state"] == "failed"
    assert BROKEN[name][1] in plugin["error"]
    assert plugin["provides"] == {}
    assert plugin["distribution"] == f"crowdbot-{name} 0.3"
    assert plugin["file"].endswith(f"plugin_{name}.py")


def test_none_hides_another(listed: dict[str, list[dict[str, Any]]]) -> None:
    healthy = {n for n, found in listed.items() if any(p["state"] == "ok" for p in found)}
    assert healthy == {"builtin", "good"}
    (good,) = listed["good"]
    assert good["provides"] == {"planner": ["good.go"]}
    assert good["components"][0]["build"] == "nowhere:build"


def test_a_shared_name_disables_both_and_names_files(
    listed: dict[str, list[dict[str, Any]]],
) -> None:
    for plugin in listed["shared"]:
        error = plugin["error"]
        assert error.startswith("E301 plugin name 'shared' is claimed by ")
        for part in ("crowdbot-first 0.3", "crowdbot-second 1.0", "first.py", "second.py"):
            assert part in error
    assert len(listed["shared"]) == 2


def test_the_name_of_our_own_is_refused(listed: dict[str, list[dict[str, Any]]]) -> None:
    states = {p["distribution"].split()[0]: p for p in listed["builtin"]}
    assert states["crowdbot"]["state"] == "ok"
    assert "'builtin' is crowdbot's own" in states["crowdbot-usurper"]["error"]


def test_names_and_entries_that_mean_nothing(listed: dict[str, list[dict[str, Any]]]) -> None:
    assert "'dashed_name' would do" in listed["Dashed-Name"][0]["error"]
    assert "no_such_plugin" in listed["nowhere"][0]["error"]
    assert "names no module" in listed["odd_value"][0]["error"]


def test_the_table_is_whole_and_tracebacks_come_on_request(site: Site) -> None:
    plain = site.run("plugins")
    assert plain.returncode == 0
    assert "Traceback" not in plain.stdout + plain.stderr
    assert plain.stdout.startswith("plugin ")
    assert "hello from import" in plain.stderr
    done = site.run("plugins", "-v")
    assert "Traceback" in done.stderr
    assert "import no_such_module" in done.stderr


def test_a_document_that_names_what_failed_is_told(site: Site) -> None:
    document = "crowdbot: 1\nkinds: {future.go: 1}\nscenario: {id: x}\n"
    (site.folder / "x.yaml").write_text(document)
    done = site.run("validate", "x.yaml")
    assert done.returncode == 1
    assert "unknown kind 'future.go'" in done.stderr
    assert "plugin 'future' (crowdbot-future 0.3) failed: crowdbot-future 0.3" in done.stderr
    for words in (["plugins", "show", "missing.go"], ["validate", "missing:office"]):
        done = site.run(*words)
        assert done.returncode == 1
        assert "plugin 'missing' (crowdbot-missing 0.3) failed" in done.stderr


def test_a_build_that_does_not_resolve(site: Site) -> None:
    done = site.run("plugins", "check", "good.go")
    assert done.returncode == 1
    assert "'good.go': build 'nowhere:build' not found" in done.stdout
    done = site.run("simulate", "challenge-2020", "in-d0125-slow-c01-r02", "--planner", "good.go")
    assert done.returncode == 3
    assert done.stderr.endswith(
        "error: planner 'good.go' (crowdbot-good 0.3): build 'nowhere:build' not found: No module "
        "named 'nowhere'\n"
    )
    assert not (site.folder / "runs").exists()


def test_a_failed_plugin_fails_its_check(site: Site) -> None:
    done = site.run("plugins", "check", "syntax")
    assert done.returncode == 1
    assert "SyntaxError" in done.stdout


#: Modules that break crowdbot's process rather than themselves.
THREAD = (
    "\nimport threading\ndef go(): raise OSError('no bus')\nthreading.Thread(target=go).start()\n"
)
REPLACES = (
    "\nimport crowdbot.dsl.suite.expand as e\n"
    "def no(*_, **__): raise ZeroDivisionError('mine')\n"
    "e.expand_document = e.load_document = no\n"
)


def test_what_a_thread_of_a_plugin_raises_is_one_line(tmp_path: Path) -> None:
    site = Site(tmp_path)
    site.install("thread", planner("thread.go") + THREAD)
    done = site.run("plugins")
    assert (done.returncode, "thread.go" in done.stdout) == (0, True)
    assert "ended: OSError: no bus (" in done.stderr
    assert "plugin_thread.py" in done.stderr
    assert "Traceback" not in done.stderr
    assert "Traceback" in site.run("plugins", CROWDBOT_DEBUG="1").stderr


def test_an_internal_error_names_the_plugins_of_others(tmp_path: Path) -> None:
    site = Site(tmp_path)
    site.install("replaces", planner("replaces.go") + REPLACES)
    done = site.run("validate", "challenge-2020")
    assert done.returncode == 4
    assert "internal error ZeroDivisionError: mine" in done.stderr
    assert done.stderr.endswith(
        "CROWDBOT_PLUGINS=builtin to see whether it is a plugin's: replaces\n"
    )
    assert site.run("validate", "challenge-2020", CROWDBOT_PLUGINS="builtin").returncode == 0


# ----------------------------------------------------------------------- allow-list
@pytest.fixture
def two(tmp_path: Path) -> Site:
    site = Site(tmp_path)
    site.install("one", planner("one.go"))
    site.install("other", planner("other.go"))
    return site


def test_only_allowed_plugins_are_imported(two: Site) -> None:
    (two.folder / "plugin_other.py").write_text("raise SystemError('imported')")
    found = two.plugins(CROWDBOT_PLUGINS="builtin, one")
    assert {n: p[0]["state"] for n, p in found.items()} == {
        "builtin": "ok",
        "one": "ok",
        "other": "off",
    }
    done = two.run("plugins", "show", "other.go", CROWDBOT_PLUGINS="one")
    assert done.returncode == 1
    assert "is installed but not allowed: CROWDBOT_PLUGINS=one" in done.stderr


def test_an_unknown_name_on_the_list_is_told(two: Site) -> None:
    done = two.run("plugins", CROWDBOT_PLUGINS="oen,other")
    assert done.returncode == 0
    assert "CROWDBOT_PLUGINS: no plugin 'oen' is installed; did you mean 'one'?" in done.stderr


def test_without_plugins(two: Site) -> None:
    found = two.plugins("--no-plugins")
    assert {n: p[0]["state"] for n, p in found.items()} == {
        "builtin": "ok",
        "one": "off",
        "other": "off",
    }
    (two.folder / "x.yaml").write_text("crowdbot: 1\nkinds: {one.go: 1}\nscenario: {id: x}\n")
    done = two.run("validate", "x.yaml", "--no-plugins")
    assert "(crowdbot-one 0.3) is installed but not allowed: --no-plugins" in done.stderr


def test_the_same_distribution_twice_is_no_collision(two: Site) -> None:
    again = Site(two.folder / "again")
    again.folder.mkdir()
    again.install("one", planner("one.go"), version="0.4")
    (plugin,) = two.plugins(more_paths=str(again.folder))["one"]
    assert (plugin["state"], plugin["distribution"]) == ("ok", "crowdbot-one 0.3")
