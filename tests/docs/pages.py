# Finds the commands, programs and inline commands that the documentation shows, page by page.
# SPDX-License-Identifier: Apache-2.0
"""Reads Markdown. A block holds commands when it is marked console, sh or bash, or when its first line begins with a command's name."""
import dataclasses
import pathlib
import re

COMMANDS = r"(\$ |glint |build/release/apps/glint/glint |\./(demo|check)\b|docs/build|tools/\w+\.py|cmake |ninja |ctest |python3 |PYTHONPATH=|sudo |apt-get )"


@dataclasses.dataclass(frozen=True)
class Block:
    """Holds a fenced block. `kind` is shell, python, cpp or other, and `text` is what is run."""
    page: str
    line: int
    kind: str
    text: str

    @property
    def place(self):
        return f"{self.page}:{self.line}"


def pages(root: pathlib.Path) -> list[pathlib.Path]:
    """Returns the README and all pages of docs/ except those that `glint` generates."""
    generated = {"config.md", "stats.md", "metrics.md", "isa.md"}
    docs = [path for path in sorted((root / "docs").rglob("*.md")) if path.parent.name != "isa" and path.name not in generated]
    return [root / "README.md", root / "CONTRIBUTING.md", root / "python/README.md", *docs]


def blocks(root: pathlib.Path, path: pathlib.Path) -> list[Block]:
    text = path.read_text(encoding="utf-8")
    found = []
    for match in re.finditer(r"^```([^\n`]*)\n(.*?)^```", text, re.M | re.S):
        language, body = match[1].strip(), match[2]
        found.append(Block(str(path.relative_to(root)), text[: match.start()].count("\n") + 2, _kind(language, body), _shell(body) if _kind(language, body) == "shell" else body))
    return found


def _kind(language, body):
    if language in ("console", "sh", "bash", "shell"):
        return "shell"
    if language == "" and re.match(COMMANDS, body.lstrip()):
        return "shell"
    return {"python": "python", "cpp": "cpp"}.get(language, "other")


def _shell(body):
    """Returns the lines after prompts, with their continuation lines, or the whole block if it has no prompts."""
    lines = body.splitlines()
    if not any(line.startswith("$ ") for line in lines):
        return body
    out, goes_on = [], False
    for line in lines:
        if line.startswith("$ ") or goes_on:
            out.append(line.removeprefix("$ "))
            goes_on = line.endswith("\\")
    return "\n".join(out) + "\n"


def inline(root: pathlib.Path, path: pathlib.Path) -> list[tuple[str, str]]:
    """Returns (place, words) of every `glint ...` in running text."""
    text = re.sub(r"^```.*?^```", lambda match: re.sub(r"[^\n]", " ", match[0]), path.read_text(encoding="utf-8"), flags=re.M | re.S)
    found = []
    for match in re.finditer(r"`(glint\s[^`]+)`", text):
        found.append((f"{path.relative_to(root)}:{text[: match.start()].count(chr(10)) + 1}", " ".join(match[1].split())))
    return found
