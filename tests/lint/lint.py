# Rules about the sources that no compiler checks: layers, sizes, headers, READMEs, docs, policies.
# SPDX-License-Identifier: Apache-2.0
"""usage: lint.py RULE SOURCE_DIR [GLINT_BINARY]; exit status 0 when the rule holds, findings on stdout."""
import pathlib
import re
import subprocess
import sys

import includes as standard_includes

SOURCE_FOLDERS = ["base", "engine", "isa", "frontend", "memsys", "rtunit", "exec", "core", "pictures", "scenes", "pipeline", "amber", "vulkan", "report", "setup", "apps", "bench"]
LIBRARIES = [folder for folder in SOURCE_FOLDERS if folder not in ("apps", "bench")]
MAX_FILE_LINES, MAX_FUNCTION_LINES = 400, 60
CLANG_FORMAT = 14  # versions lay out differently, so only this one may judge
# Functions that may be longer, each with the reason.
LONG_FUNCTIONS_ALLOWED: dict[str, str] = {"joined_rows": "a table of ops, one row an op", "DramStats": "a list of statistics, not a body"}
LONG_FILES_ALLOWED: dict[str, str] = {}


def files(root, folders, suffixes=(".h", ".cpp")):
    found = []
    for folder in folders:
        found += [p for p in (root / folder).rglob("*") if p.suffix in suffixes]
    return sorted(found)


def layers(root):
    """Checks that every include goes down the layers."""
    allowed = {}
    for line in (root / "tests/lint/layers.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            name, below = line.split(":")
            allowed[name] = below.split()
    folder_of = lambda path: "apps/glint" if path.startswith("apps/") else path.split("/")[0]
    problems = []
    for path in files(root, SOURCE_FOLDERS):
        name = str(path.relative_to(root))
        own = folder_of(name)
        if own not in allowed:
            problems.append(f"{name}: folder {own} is not in tests/lint/layers.txt")
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = re.match(r'\s*#include\s+"([^"]+)"', line)
            if not match:
                continue
            target = match.group(1)
            if not (root / target).exists():
                problems.append(f'{name}:{number}: "{target}" is not a path from the root')
            elif folder_of(target) != own and allowed[own] != ["all"] and folder_of(target) not in allowed[own]:
                problems.append(f"{name}:{number}: {own} may not include {target}")
    return problems


def function_lengths(path):
    """(lines, name, line) of each function body; relies on clang-format: a body closes at its opener's indentation."""
    lines = path.read_text().splitlines()
    found = []
    for i, line in enumerate(lines):
        if not line.endswith("{") or re.match(r"\s*(namespace|struct|class|enum|union|extern|using|}|//)", line):
            continue
        start = i  # a declaration may take several lines, an initialiser list among them
        while start > 0 and lines[start - 1].strip() and not re.search(r"([;{}>:]|//.*)$", lines[start - 1]):
            start -= 1
        indent = len(lines[start]) - len(lines[start].lstrip())
        match = re.search(r"([\w:~]+)\s*\(", lines[start])
        if not match or match.group(1) in ("if", "for", "while", "switch", "catch", "return") or re.match(r"\s*\[", lines[start]):
            continue
        for j in range(i + 1, len(lines)):
            if lines[j].startswith(" " * indent + "}") and len(lines[j]) - len(lines[j].lstrip()) == indent:
                found.append((j - start + 1, match.group(1), start + 1))
                break
    return found


def sizes(root):
    """Checks that files and functions stay short, and lists the ten longest functions."""
    problems, functions = [], []
    for path in files(root, SOURCE_FOLDERS):
        name = str(path.relative_to(root))
        count = len(path.read_text().splitlines())
        if count > MAX_FILE_LINES and name not in LONG_FILES_ALLOWED:
            problems.append(f"{name}: {count} lines, at most {MAX_FILE_LINES}")
        functions += [(length, f"{name}:{line} {function}", function) for length, function, line in function_lengths(path)]
    functions.sort(reverse=True)
    for length, place, _ in functions[:10]:
        print(f"note: {length:4} lines  {place}")
    problems += [f"{place}: {length} lines, at most {MAX_FUNCTION_LINES}" for length, place, function in functions
                 if length > MAX_FUNCTION_LINES and function not in LONG_FUNCTIONS_ALLOWED]
    return problems


def clang_format():
    """Returns the command of the version that the tree is laid out with, or None."""
    for name in (f"clang-format-{CLANG_FORMAT}", "clang-format"):
        try:
            out = subprocess.run([name, "--version"], capture_output=True, text=True, check=True).stdout
        except (OSError, subprocess.CalledProcessError):
            continue
        if re.search(rf"version {CLANG_FORMAT}\b", out):
            return name
    return None


def layout(root):
    """Checks that every source is laid out as clang-format does it."""
    command = clang_format()
    if command is None:
        print(f"SKIPPED: layout: clang-format {CLANG_FORMAT} is not installed")
        return []
    paths = [str(path) for path in files(root, SOURCE_FOLDERS + ["tests"])]
    out = subprocess.run([command, "--dry-run", "--ferror-limit=1", *paths], capture_output=True, text=True, cwd=root).stderr
    found = sorted({line.split(": ")[0] for line in out.splitlines() if "-Wclang-format-violations" in line})
    return [f"{pathlib.Path(place.split(':')[0]).relative_to(root)}:{place.split(':')[1]}: clang-format -i would change it" for place in found]


def includes(root):
    """Checks that each file includes the standard headers that it uses."""
    return standard_includes.problems(root, files(root, SOURCE_FOLDERS + ["tests"]))


def headers(root):
    """Checks that each source begins with a sentence and the licence, and that headers are guarded."""
    problems = []
    for path in files(root, SOURCE_FOLDERS + ["tests", "shaders", "python"], (".h", ".cpp", ".py", ".sh", ".glsl", ".rgen", ".rchit", ".rahit", ".rint", ".rmiss")):
        name = str(path.relative_to(root))
        lines = path.read_text().splitlines()
        # A sentence may take several comment lines; a shader's #version must come first.
        head = [line for line in lines[:12] if line and not line.startswith(("#version", "#!", "#extension"))]
        marker = "#" if path.suffix in (".py", ".sh") else "//"
        if not head or not re.match(rf"{marker} \S.*", head[0]) or "SPDX" in head[0]:
            problems.append(f"{name}:1: does not begin with a sentence of what it is")
        if not any("SPDX-License-Identifier: Apache-2.0" in line for line in lines[:40]):
            problems.append(f"{name}: no SPDX line")
        if path.suffix == ".h" and "#pragma once" not in lines:
            problems.append(f"{name}: no #pragma once")
    return problems


def readmes(root):
    """Checks that every folder of sources explains itself in at most 40 lines, and that tests/README.md names every folder of tests."""
    listed = (root / "tests/README.md").read_text() if (root / "tests/README.md").exists() else ""
    folders = sorted(path.name for path in (root / "tests").iterdir() if path.is_dir() and path.name != "__pycache__")
    problems = [f"tests/README.md: does not name {folder}/" for folder in folders if f"`{folder}/`" not in listed]
    for folder in LIBRARIES + ["apps/glint", "configs", "labs", "shaders", "python"]:
        readme = root / folder / "README.md"
        if not readme.exists():
            problems.append(f"{folder}: no README.md")
        elif len(readme.read_text().splitlines()) > 40:
            problems.append(f"{folder}/README.md: more than 40 lines")
    return problems


def doc_paths(root):
    """Checks that the paths that the docs name exist. A path is a `code` word with a slash in which only its folder must be ours."""
    tops = {p.name for p in root.iterdir()} - {"build", "out"}
    problems = []
    for path in sorted(list(root.glob("*.md")) + list((root / "docs").glob("*.md")) + list((root / "docs/howto").glob("*.md")) + [root / f / "README.md" for f in LIBRARIES + ["apps/glint", "configs", "labs", "shaders", "python"]]):
        if not path.exists():
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            words = re.findall(r"`([\w./-]+/[\w./-]*)`", line) + re.findall(r"\]\(([\w./-]+)\)", line)
            for word in words:
                candidates = [root / word, path.parent / word]
                if (word.split("/")[0] in tops or "](" + word in line) and not any(c.exists() for c in candidates):
                    problems.append(f"{path.relative_to(root)}:{number}: {word} does not exist")
    return problems


def semantics(root):
    """Checks that every rule of docs/semantics.md names tests, between asterisks, and that those exist."""
    known = set()
    for path in (root / "tests").rglob("*_test.cpp"):
        text = re.sub(r'"\s*\n\s*"', "", path.read_text())
        known |= set(re.findall(r'TEST_CASE\(\s*"([^"]*)"', text))
    for path in (root / "tests").rglob("*_test.py"):
        known |= set(re.findall(r"def (test_\w+)", path.read_text()))
    problems = []
    for number, line in enumerate((root / "docs/semantics.md").read_text().splitlines(), 1):
        if not line.startswith("- "):
            continue
        names = re.findall(r"\*([^*]+)\*", line)
        if not names:
            problems.append(f"docs/semantics.md:{number}: names no test")
        problems += [f"docs/semantics.md:{number}: there is no test '{name}'" for name in names if name not in known]
    return problems


def wording(root):
    """Checks that there are no loose ends, and that libraries neither read the environment nor print."""
    problems = []
    for path in files(root, SOURCE_FOLDERS):
        name = str(path.relative_to(root))
        library = not name.startswith(("apps/", "bench/")) and name != "vulkan/settings.cpp"  # The environment is the driver's command line.
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if re.search(r"\b(TODO|FIXME|XXX|HACK)\b", line):
                problems.append(f"{name}:{number}: loose end: {line.strip()}")
            code = line.split("//")[0]
            if library and re.search(r"\bgetenv\s*\(|\bstd::cout\b|\bstd::cerr\b|(?<!\w)(std::)?printf\s*\(|\bfmt::print\b|\bstd::rand\b", code):
                if not (name == "report/terminal/progress.cpp" and "fmt::print(stream_" in code):
                    problems.append(f"{name}:{number}: a library does not print or read the environment: {line.strip()}")
            if re.search(r"#include\s+<(ranges|expected|format|source_location)>", code):
                problems.append(f"{name}:{number}: not in both compilers: {line.strip()}")
    return problems


def policies(root, glint):
    """Checks that each policy file registers exactly one policy, and that the linker kept them all."""
    out = subprocess.run([glint, "list", "policies"], capture_output=True, text=True, check=True).stdout
    registered = {}
    for line in out.splitlines():
        folder = line.split()[0]
        registered[folder] = registered.get(folder, 0) + 1
    globbed = set()
    for cmake in root.glob("*/CMakeLists.txt"):
        match = re.search(r"POLICIES ([\w ]+)", cmake.read_text())
        if match:
            globbed |= {f"{cmake.parent.name}/{sub}" for sub in match.group(1).split()}
    problems = [f"{folder}: not known to `glint list policies`: its interface has no PolicyKind, or no file registers" for folder in sorted(globbed - set(registered))]
    for folder, count in sorted(registered.items()):
        in_folder = len(list((root / folder).glob("*.cpp")))
        if in_folder != count:
            problems.append(f"{folder}: {in_folder} files, {count} registered policies")
    return problems if registered else ["`glint list policies` printed nothing"]


def main():
    rule, root = globals()[sys.argv[1]], pathlib.Path(sys.argv[2]).resolve()
    problems = rule(root, *sys.argv[3:])
    for problem in problems:
        print(problem)
    print(f"{len(problems)} findings")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
