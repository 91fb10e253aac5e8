"""What a planner's process cannot reach: files, network, signals, other processes."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from crowdbot.core.planning.choice import PlannerPlace
from crowdbot.core.planning.containment import landlock
from crowdbot.core.planning.containment.offer import ALL, Offer, kernel_offer
from crowdbot.core.planning.containment.scratch import remove_scratch
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.errors import InputError, PlannerError
from tests.core.planning.process.process_cases import (
    REGISTRY,
    choose,
    hosted,
    observation,
    older_kernel,
    planner_text,
)

pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or kernel_offer().missing != "", reason="this kernel contains nothing"
)

TOP = """
import array, fcntl, resource, socket, mmap, multiprocessing, tempfile
FATHER, FILE = os.getppid(), os.path.abspath(__file__)
FOLDER = os.path.dirname(FILE)
def call(name, *given):
    libc = ctypes.CDLL(None, use_errno=True)
    if getattr(libc, name)(*given) == -1:
        raise OSError(ctypes.get_errno(), name)
def mark():
    flags = array.array('l', [0])
    with open(FILE) as file:
        fcntl.ioctl(file, 0x80086601, flags)
        flags[0] |= 0x40
        fcntl.ioctl(file, 0x40086602, flags)
def count(attempts):
    denied = []
    for k, attempt in enumerate(attempts):
        try:
            eval(attempt)
        except OSError as error:
            denied.append(error.errno in (1, 13, 18, 38))
        else:
            denied.append(False)
    return [k for k, one in enumerate(denied) if not one]
"""
#: Each has to fail with EPERM, EACCES, EXDEV or ENOSYS.
DENIED = [
    # files
    "open(FOLDER + '/new', 'w')", "open(FILE, 'a')", "os.remove(FILE)", "os.mkdir(FOLDER + '/d')",
    "os.rename(FILE, FILE + 'x')", "os.link(FILE, os.path.expanduser('~/l'))",
    "os.symlink('/', FOLDER + '/s')", "os.mkfifo(FOLDER + '/f')", "open(FOLDER + '/secret.txt')",
    "os.truncate(FILE, 0)", "os.open(FILE, os.O_RDONLY | os.O_TRUNC)", "os.chmod(FILE, 0o777)",
    "os.chown(FILE, 1, 1)", "os.utime(FILE)", "os.setxattr(FILE, 'user.a', b'x')",
    "mark()", "call('inotify_init1', 0)", "call('fanotify_init', 0x200, 0)",
    # the folder of its folder, which outlives the run
    "open(os.path.expanduser('~/../note'), 'w')", "os.listdir(os.path.expanduser('~/..'))",
    "os.rename(os.path.expanduser('~'), os.path.expanduser('~/../other'))",
    "open('/dev/shm/x', 'w')", "open('/etc/shadow')", "os.listdir('/')", "os.listdir('/tmp')",
    # other processes
    "os.kill(FATHER, 0)", "os.kill(1, 0)", "open(f'/proc/{FATHER}/status')",
    "open(f'/proc/{FATHER}/mem', 'r+b')", "os.readlink(f'/proc/{FATHER}/exe')",
    "os.listdir('/proc')",
    "resource.prlimit(FATHER, resource.RLIMIT_AS, (1, 1))", "resource.prlimit(FATHER, 7)",
    "os.sched_setaffinity(FATHER, {0})", "os.setpriority(os.PRIO_PROCESS, FATHER, 19)",
    "os.setpriority(os.PRIO_USER, 0, 19)", "call('ptrace', 0x4206, FATHER, None, None)",
    "os.sched_setscheduler(FATHER, os.SCHED_BATCH, os.sched_param(0))",
    "call('unshare', 0x10000000)", "call('shmget', 1, 4096, 0o1777)", "call('setns', 0, 0)",
    # network
    "socket.socket()", "socket.socket(socket.AF_INET, socket.SOCK_DGRAM)",
    "socket.socket(socket.AF_UNIX)", "socket.socket(socket.AF_NETLINK, socket.SOCK_RAW)",
    "call('fcntl', 0, 8, FATHER)", "socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)",
    "socket.socketpair(socket.AF_UNIX, socket.SOCK_RAW)",
]  # fmt: skip
#: What planners do that do nothing wrong.
ALLOWED = [
    "open(FILE).read()", "open(FOLDER + '/weights.txt').read()", "socket.socketpair()",
    "fcntl.ioctl(open(FILE), 0x80086601, array.array('l', [0]))",
    "socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)",
    "open(os.path.expanduser('~/mine'), 'w').write('x')", "tempfile.TemporaryDirectory()",
    "os.rename(os.path.expanduser('~/mine'), os.path.expanduser('~/yours'))",
    "threading.Thread(target=time.time).start()", "mmap.mmap(-1, 4096)", "os.nice(0)",
    "subprocess.check_call(['true'])", "subprocess.Popen(['sleep', '9']).kill()",
    "resource.setrlimit(resource.RLIMIT_CPU, (60, 60))", "open('/proc/self/maps').read()",
    "open('/proc/cpuinfo').read()", "open('/dev/null', 'w').write('x')", "os.urandom(4)",
    "os.kill(os.getpid(), 0)", "os.sched_setaffinity(0, os.sched_getaffinity(0))",
    "__import__('scipy.optimize')", "__import__('numba').njit(lambda x: x + 1)(1)",
    "multiprocessing.get_context('fork').Process(target=time.time).start()",
    "__import__('beside')",
]  # fmt: skip


def _failing(folder: Path, attempts: list[str]) -> PlannerError:
    (folder / "secret.txt").write_text("where people walk")
    (folder / "weights.txt").write_text("1 2 3")
    (folder / "beside.py").write_text("x = 1\n")
    step = f"import beside; raise ValueError(count({attempts!r}))"
    text = planner_text(step, top=TOP)
    text = text.replace("class Mine:", "class Mine:\n    data = 'weights.txt'")
    with hosted(choose(folder, text)) as host, pytest.raises(PlannerError) as caught:
        host.step(observation())
    return caught.value


def test_what_it_cannot_reach(tmp_path: Path) -> None:
    every = list(range(len(ALLOWED)))
    assert "ValueError: [] (" in str(_failing(tmp_path, DENIED))
    assert f"ValueError: {every} (" in str(_failing(tmp_path, ALLOWED))


@pytest.mark.parametrize("version", [1, 4, 5])
def test_an_older_landlock_denies_as_much(
    version: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Signals are denied by the filter then, those to its own children with them."""
    with older_kernel(monkeypatch, version):
        assert kernel_offer().contained == ALL
        assert "ValueError: [] (" in str(_failing(tmp_path, DENIED))


def test_a_kernel_without_landlock(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    write = f"open({str(tmp_path / 'x')!r}, 'w').write('x'); return (0.1, 0.0)"
    with older_kernel(monkeypatch, 0):
        choice = choose(tmp_path, planner_text(write))
        with hosted(choice) as host:
            host.step(observation())
        assert choice.contained == []
        assert (tmp_path / "x").read_text() == "x"
        assert (
            "not contained: files, network, signals, processes: this system has no" in caplog.text
        )
        with pytest.raises(InputError, match=r"would not be contained .*--not-contained"):
            choose(tmp_path, planner_text(write), PlannerPlace(contained=True))


def test_what_is_said_of_parts() -> None:
    assert Offer(7, filter=True).missing == ""
    assert Offer(7, filter=False).contained == ("signals",)
    assert Offer(0, filter=True).contained == ("network", "signals", "processes")
    assert Offer(0, filter=True).missing.startswith("files: this system has no Landlock")


def test_a_denied_file_is_named(tmp_path: Path) -> None:
    read = planner_text("open('/etc/shadow')")
    with hosted(choose(tmp_path, read)) as host, pytest.raises(PlannerError) as caught:
        host.step(observation())
    assert "Permission denied: '/etc/shadow'" in str(caught.value)
    assert "declare" in str(caught.value)


def test_network_only_for_a_document_that_asks(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(
        planner_text("import socket; socket.socket(); return (0.2, 0)")
    )
    document = f"python: {sys.executable}\nplanner: mine.py:Mine\n"
    for asks in (False, True):
        (tmp_path / "p.yaml").write_text(document + ("network: true\n" if asks else ""))
        choice = resolve_planner(str(tmp_path / "p.yaml"), REGISTRY)
        assert choice.spec_dump.get("network", False) is asks
        with hosted(choice) as host:
            if asks:
                assert host.step(observation()).command.v == 0.2
            else:
                with pytest.raises(PlannerError, match="PermissionError"):
                    host.step(observation())


def test_libraries_of_a_document(tmp_path: Path) -> None:
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "table.txt").write_text("0.25")
    read = f"return (float(open({str(tmp_path / 'own' / 'table.txt')!r}).read()), 0)"
    (tmp_path / "mine.py").write_text(planner_text(read))
    document = f"python: {sys.executable}\nplanner: mine.py:Mine\n"
    (tmp_path / "p.yaml").write_text(document)
    choice = resolve_planner(str(tmp_path / "p.yaml"), REGISTRY)
    with hosted(choice) as host, pytest.raises(PlannerError, match="PermissionError"):
        host.step(observation())
    (tmp_path / "p.yaml").write_text(document + "libraries: [own]\n")
    with hosted(resolve_planner(str(tmp_path / "p.yaml"), REGISTRY)) as host:
        assert host.step(observation()).command.v == 0.25


def test_a_fork_bomb_ends(tmp_path: Path) -> None:
    bomb = planner_text("\n        while True:\n            os.fork()")
    with hosted(choose(tmp_path, bomb)) as host, pytest.raises(PlannerError) as caught:
        host.step(observation())
    assert "more than 256 processes" in str(caught.value)


def test_whatever_it_leaves_in_its_folder_is_deleted(tmp_path: Path) -> None:
    deep = tmp_path / "scratch"
    deep.mkdir()
    (tmp_path / "kept").mkdir()
    (deep / "link").symlink_to(tmp_path / "kept")
    here = os.getcwd()  # noqa: PTH109 - restored below
    try:
        os.chdir(deep)
        for _ in range(1500):
            Path("d" * 200).mkdir()
            os.chdir("d" * 200)
    finally:
        os.chdir(here)
    remove_scratch(str(deep))
    assert not deep.exists()
    assert (tmp_path / "kept").exists()


def test_versions_know_their_rights() -> None:
    assert landlock.abi() >= 1
