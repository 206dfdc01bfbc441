"""The documentation does what it says: every Python block runs, every command runs or says why it does not here.

A shell block is fenced as ```bash and is run; ```bash ros-desktop needs a ROS 2 desktop; ```bash ci is run by .ci/run;
```bash hand is for a person to watch. In each, the executables and launch files of this tree that it names must exist.
"""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
FENCE = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
KINDS = ("", "ros-desktop", "ci", "hand")


def blocks(page, language):
    return [(m[2].strip(), m[3]) for m in FENCE.finditer(page.read_text()) if m[1] == language]


def pages_with(language):
    return [page for page in PAGES if blocks(page, language)]


def name_of(page):
    return str(page.relative_to(ROOT))


@pytest.mark.parametrize("page", pages_with("python"), ids=name_of)
def test_python_blocks_run_in_order(page, tmp_path):
    code = "\n".join(text for _, text in blocks(page, "python"))
    run = ["-m", "doctest", str(page)] if ">>> " in code else ["-c", code]
    done = subprocess.run([sys.executable, *run], cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("page", pages_with("bash"), ids=name_of)
def test_shell_blocks_run(page, tmp_path):
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    for kind, text in blocks(page, "bash"):
        assert kind in KINDS, f"```bash {kind} is none of {KINDS}"
        if kind:
            continue
        done = subprocess.run(
            ["bash", "-euc", text], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300
        )
        assert done.returncode == 0, f"{text}\n{done.stdout}{done.stderr}"


@pytest.mark.parametrize("page", pages_with("bash"), ids=name_of)
def test_what_a_command_names_exists(page):
    makefile = (ROOT / "Makefile").read_text()
    for _, text in blocks(page, "bash"):
        for line in text.splitlines():
            words = shlex.split(line, comments=True)
            if words[:1] == ["make"] and len(words) > 1:
                assert re.search(rf"^{words[1]}:", makefile, re.MULTILINE), line
            if words[:2] == ["ros2", "run"]:
                assert (ROOT / "src" / words[2] / "scripts" / words[3]).is_file(), line
            if words[:2] == ["ros2", "launch"]:
                assert (ROOT / "src" / words[2] / "launch" / words[3]).is_file(), line


def test_ci_runs_what_is_marked_for_it():
    ci = (ROOT / ".ci" / "run").read_text()
    for page in pages_with("bash"):
        for kind, text in blocks(page, "bash"):
            for line in text.splitlines() if kind == "ci" else ():
                command = line.split("#")[0].strip()
                assert command in ci, f"{name_of(page)}: .ci/run does not run {command!r}"


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_within_the_tree_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text()):
        if not re.match(r"[a-z]+:", target):
            assert (page.parent / target).exists(), f"{name_of(page)} links to {target}"
