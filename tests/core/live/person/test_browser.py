"""The person's page in a real browser: keys and a gamepad drive, and the recording agrees."""

from __future__ import annotations

import json
import subprocess
import sys
from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from tests.browser import PROGRAM, axe_findings, needs_axe, needs_browser
from tests.core.live.person.test_teleop import _commands, _limits
from tests.paths import DATA, ROOT

pytestmark = [pytest.mark.slow, needs_browser]
SHORT = str(DATA / "short_way.yaml")
IWER = ROOT / "scripts/js/node_modules/iwer/build/iwer.min.js"
_SOFTWARE = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
#: A gamepad that the page cannot tell from a real one.
_GAMEPAD = """
  window.fakePad = { id: "fake pad", connected: true, axes: [0, 0, 0, 0], timestamp: 0,
    buttons: Array.from({ length: 16 }, () => ({ pressed: false, value: 0 })) };
  navigator.getGamepads = () => [window.fakePad];
"""


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=PROGRAM, args=_SOFTWARE)
        yield browser
        browser.close()


class Command:
    """The command in a process of its own, and the address that it prints."""

    def __init__(self, *argv: str) -> None:
        code = "import sys; from crowdbot.cli import main; sys.exit(main())"
        self._process = subprocess.Popen(
            [sys.executable, "-c", code, *argv], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            text=True, cwd=ROOT,
        )  # fmt: skip
        assert self._process.stderr is not None
        while "token=" not in (line := self._process.stderr.readline()):
            assert line, "it ended before it printed an address"
        self.url = line.split()[-1]

    def ended(self) -> dict[str, Any]:
        """The record and the scores, when the run is over."""
        text, complaints = self._process.communicate(timeout=300)
        assert self._process.returncode == 0, complaints
        return dict(json.loads(text))

    def end(self) -> None:
        """End it, whatever it does."""
        self._process.kill()
        self._process.communicate()


@pytest.fixture
def opened(browser: Browser, tmp_path: Path) -> Iterator[Callable[..., tuple[Page, Command]]]:
    """Start a command and open its page."""
    pages, commands = list[Page](), list[Command]()

    def start(*argv: str, fragment: str = "#view=plan", init: str = "") -> tuple[Page, Command]:
        command = Command(*argv, "--out", str(tmp_path), "--no-references", "--json")
        commands.append(command)
        page = browser.new_context(viewport={"width": 1280, "height": 800}).new_page()
        pages.append(page)
        page.on("pageerror", lambda e: pytest.fail(str(e)))
        if init:
            page.add_init_script(init)
        page.goto(command.url + fragment)
        page.wait_for_selector("html[data-ready]")
        until(page, "!byId('begin').hidden")
        return page, command

    yield start
    for page in pages:
        page.context.close()
    for command in commands:
        command.end()


def until(page: Page, condition: str) -> None:
    for _ in range(1500):
        if page.evaluate(condition):
            return
        page.wait_for_timeout(20)
    pytest.fail(f"never true: {condition}")


def _ended(page: Page, command: Command) -> dict[str, Any]:
    until(page, "words.end !== null")
    return command.ended()


def test_keys_and_a_gamepad_drive_and_the_recording_agrees_sample_by_sample(
    opened: Callable[..., tuple[Page, Command]],
) -> None:
    limit = "robots.robot.task.time_limit=4"
    page, command = opened("teleop", SHORT, "--set", limit, init=_GAMEPAD)
    page.evaluate(
        """() => {
          window.used = []; window.sticks = {};
          const taken = link.on.taken; link.on.taken = (m) => { used.push([m.t, m.n]); taken(m); };
          const raw = WebSocket.prototype.send;
          WebSocket.prototype.send = function (text) {
            const m = JSON.parse(text);
            if (m.op === "stick") sticks[m.n] = m;
            raw.call(this, text);
          };
        }"""
    )
    page.keyboard.press("Enter")
    until(page, "shown.told && shown.told.t >= 0.3")
    page.keyboard.down("ArrowUp")
    page.wait_for_timeout(300)
    page.keyboard.down("KeyA")
    page.wait_for_timeout(300)
    page.keyboard.up("ArrowUp")
    page.keyboard.up("KeyA")
    page.wait_for_timeout(200)
    page.evaluate("fakePad.axes[1] = -1; fakePad.axes[0] = 0.56; fakePad.timestamp++")
    until(page, "used.some(([, n]) => Math.abs((sticks[n]?.left ?? 0) + 0.5) < 1e-6)")
    page.evaluate("fakePad.axes[1] = fakePad.axes[0] = 0; fakePad.timestamp++")
    page.wait_for_timeout(200)
    page.keyboard.down("ArrowDown")
    until(page, "shown.told.t >= 3")
    page.evaluate("window.dispatchEvent(new Event('blur'))")  # the hand leaves, the key is let go
    until(page, "shown.told.t >= 3.5")
    used, sent = page.evaluate("[used, sticks]")
    sticks = defaultdict(lambda: {"ahead": 0, "left": 0}, sent)  # the first one was centred
    shown = _ended(page, command)
    run = Path(shown["directory"])
    user, limits = _commands(run, "/joystick/cmd_vel"), _limits(run)
    asked = [(s["ahead"], s["left"]) for s in (sticks[str(n)] for _, n in used)]
    assert {(1, 0), (1, 1), (0, 0), (-1, 0)} <= set(asked)
    assert any(ahead == 1 and left == pytest.approx(-0.5) for ahead, left in asked)  # the gamepad
    centred = 0  # by the dead man's switch, also where a slow machine makes the page fall silent
    for t, asked_for in user.items():
        n = max((n for since, n in used if since <= t + 1e-9), default=0)
        ahead, left = (sticks[str(n)]["ahead"], sticks[str(n)]["left"]) if n else (0, 0)
        v = ahead * (limits.v_max if ahead > 0 else -limits.v_min)
        if asked_for != pytest.approx((v, left * limits.w_max)):
            assert asked_for == (0.0, 0.0)
            centred += 1
    assert centred <= shown["live"]["missed_steps"]
    assert max(v for v, _ in user.values()) == limits.v_max
    assert user[max(user)] == (0.0, 0.0)
    assert _commands(run, "/cmd_vel") == user
    assert shown["live"]["latency"]["count"] >= 3


def test_a_reload_neither_ends_nor_falsifies_the_run(
    opened: Callable[..., tuple[Page, Command]],
) -> None:
    page, command = opened("teleop", SHORT, "--set", "robots.robot.task.time_limit=4")
    page.keyboard.press("Enter")
    until(page, "shown.told && shown.told.t >= 0.3")
    page.keyboard.down("ArrowUp")
    until(page, "shown.told.t >= 0.8")
    where = page.url
    page.goto("about:blank")
    page.wait_for_timeout(2500)  # the run waits
    page.goto(where)
    page.wait_for_selector("html[data-ready]")
    shown = _ended(page, command)
    ((wait),) = shown["live"]["waits"]
    assert wait["why"] == "disconnected"
    assert wait["seconds"] > 0.5
    assert shown["live"]["stops"][0]["why"] in ("disconnected", "hidden", "not in focus")
    user = _commands(Path(shown["directory"]), "/joystick/cmd_vel")
    assert len(user) == 64
    assert user[3.9375] == (0.0, 0.0)


def test_a_second_page_watches(opened: Callable[..., tuple[Page, Command]]) -> None:
    page, command = opened("teleop", SHORT, "--set", "robots.robot.task.time_limit=1.5")
    other = page.context.new_page()
    other.goto(page.url)
    other.wait_for_selector("html[data-ready]")
    until(other, "byId('status').textContent === 'watching'")
    assert "Another page has the seat" in other.inner_text("#banner")
    assert not other.is_visible("#begin")
    other.keyboard.press("Enter")
    other.wait_for_timeout(200)
    assert page.evaluate("words.waits") == "not begun"
    page.bring_to_front()
    page.keyboard.press("Enter")
    _ended(other, command)


@needs_axe
@pytest.mark.parametrize("name", ["teleop", "walk"])
def test_axe_finds_nothing_and_pages_fit(
    name: str, opened: Callable[..., tuple[Page, Command]]
) -> None:
    page, _ = opened(name, SHORT, "--set", "robots.robot.task.time_limit=5")
    _fits_and_has_no_findings(page)
    page.click("#begin")
    until(page, "shown.told && shown.told.t >= 0.3")
    page.click("#pause")
    until(page, "words.waits === 'paused'")
    _fits_and_has_no_findings(page)
    page.select_option("#view", "solid")
    until(page, "eyes.solid && eyes.solid.frames > 1")
    page.click("#theme")
    _fits_and_has_no_findings(page)
    page.click("#pause")
    until(page, "words.end !== null")
    _fits_and_has_no_findings(page)


def _fits_and_has_no_findings(page: Page) -> None:
    for width, height in ((360, 740), (768, 900), (1920, 1080)):
        page.set_viewport_size({"width": width, "height": height})
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert axe_findings(page) == []


def test_a_person_walks_and_sees_with_own_eyes(opened: Callable[..., tuple[Page, Command]]) -> None:
    given = ("walk", SHORT, "--at", "3,-1", "--set", "robots.robot.task.time_limit=2")
    page, command = opened(*given, fragment="")
    assert page.input_value("#view") == "eyes"
    page.keyboard.press("Enter")
    until(page, "shown.told && shown.told.t >= 0.2")
    page.keyboard.down("KeyW")
    until(page, "eyes.solid && eyes.solid.frames > 2")
    assert page.evaluate("eyes.solid.renderer.info.render.triangles") > 500
    shown = _ended(page, command)
    assert shown["scenario"].endswith("+walk")
    assert shown["live"]["steps"] == 32


def test_without_webgl_the_page_says_so(opened: Callable[..., tuple[Page, Command]]) -> None:
    no_webgl = """
      const real = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        return kind.startsWith("webgl") ? null : real.call(this, kind, ...rest); };
    """
    given = ("teleop", SHORT, "--set", "robots.robot.task.time_limit=1")
    page, command = opened(*given, fragment="#view=solid", init=no_webgl)
    assert page.is_visible("#no-webgl")
    assert page.input_value("#view") == "plan"
    page.keyboard.press("Enter")
    _ended(page, command)


@pytest.mark.skipif(not IWER.is_file(), reason="no iwer: make check-js")
def test_a_headset_stands_in_the_crowd(opened: Callable[..., tuple[Page, Command]]) -> None:
    """With an emulator of WebXR; no headset was at hand."""
    emulator = IWER.read_text(encoding="utf-8") + (
        ";window.device = new IWER.XRDevice(IWER.metaQuest3);"
        "window.device.installRuntime({ forceInstall: true });"
    )
    given = ("walk", SHORT, "--at", "3,-1", "--set", "robots.robot.task.time_limit=3")
    page, command = opened(*given, fragment="#view=eyes", init=emulator)
    page.keyboard.press("Enter")
    until(page, "eyes.solid && eyes.solid.frames > 1")
    until(page, "!byId('headset').hidden")
    page.click("#headset")
    until(page, "eyes.solid.renderer.xr.isPresenting")
    frames = page.evaluate("eyes.solid.frames")
    until(page, f"eyes.solid.frames > {frames + 2}")
    assert page.evaluate("eyes.solid.renderer.xr.getCamera().cameras.length") == 2
    page.evaluate("eyes.solid.renderer.xr.getSession().end()")
    _ended(page, command)
