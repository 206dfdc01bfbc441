"""What mkdocs needs beside its settings: the pages link to sources outside docs/, which the site brings along."""

import re
import shutil
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
BROUGHT = ("src", "benchmark", "config", "examples")


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Turn links that leave docs/ into links within the site."""
    up = "../" * page.file.src_uri.count("/")
    return re.sub(rf"\]\((?:\.\./)+({'|'.join(BROUGHT)})/", rf"]({up}\1/", markdown)


def on_post_build(config: Any, **_: Any) -> None:
    """Copy what they lead to."""
    for folder in BROUGHT:
        for path in (ROOT / folder).rglob("*"):
            if path.suffix in (".py", ".yaml", ".urdf", ".xml") and "__pycache__" not in path.parts:
                copy = Path(config["site_dir"]) / path.relative_to(ROOT)
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(path, copy)
