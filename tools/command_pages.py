# Writes manual pages and completions for bash, zsh and fish from what `glint --help` prints.
# SPDX-License-Identifier: Apache-2.0
"""usage: command_pages.py GLINT FOLDER. The files lie in FOLDER as they lie below PREFIX/share."""
import pathlib
import re
import sys

import help_text
from help_text import Entry, Help


def roff(text: str) -> str:
    """Returns text for a line of a manual page, where a leading dot or quote would begin a request."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text[:1] in (".", "'") else text


def manual(name: str, page: Help, others: list[str]) -> str:
    title = f"glint-{name}" if name else "glint"
    out = [f'.TH {title.upper()} 1 "" "Glint" "Glint"', ".SH NAME", f"{roff(title)} \\- {roff(page.summary)}", ".SH SYNOPSIS", f".B {roff(page.usage)}"]
    for heading, entries in page.sections:
        out.append(f".SH {heading.upper()}")
        for entry in entries:
            out += [".TP", f".B {roff(entry.written)}", roff(entry.meaning) or "\\&"]
    out += [".SH SEE ALSO", ", ".join(f".BR {roff(other)} (1)" if i == 0 else f"{roff(other)}(1)" for i, other in enumerate(others))]
    return "\n".join(out) + "\n"


def choices(entry: Entry) -> list[str]:
    """Returns the words of which an option takes one, as in "{timing,functional}"."""
    found = re.search(r"\{([^}]*)\}", entry.takes)
    return found[1].split(",") if found else []


def takes_file(entry: Entry) -> bool:
    return bool(re.match(r"(FILE|DIR|TEXT)", entry.takes))


def bash(pages: dict[str, Help]) -> str:
    cases = []
    for name, page in pages.items():
        words = [option for entry in page.options for option in entry.names if option.startswith("--")]
        values = "".join(f"        {'|'.join(entry.names)}) COMPREPLY=($(compgen -W '{' '.join(choices(entry))}' -- \"$word\")); return ;;\n"
                         for entry in page.options if choices(entry))
        before = f"      case \"$before\" in\n{values}      esac\n" if values else ""
        cases.append(f"    '{name}')\n{before}      words='{' '.join(words)}' ;;\n")
    commands = " ".join(name for name in pages if name)
    return f"""# Completes the words of the command glint in bash.
_glint() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command= words= i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case " {commands} " in *" ${{COMP_WORDS[i]}} "*) command=${{COMP_WORDS[i]}}; break ;; esac
  done
  case "$command" in
{"".join(cases)}  esac
  [ -n "$command" ] || words="$words {commands}"
  if [[ $word == -* || -z $command ]]; then COMPREPLY=($(compgen -W "$words" -- "$word")); fi
}}
complete -o default -F _glint glint
"""


def zsh(pages: dict[str, Help]) -> str:
    def quoted(text: str) -> str:
        return "'" + text.replace("'", "'\\''") + "'"

    def argument(entry: Entry) -> list[str]:
        meaning = re.sub(r"([\[\]:])", r"\\\1", entry.meaning)
        value = f":value:({' '.join(choices(entry))})" if choices(entry) else ":value:_files" if takes_file(entry) else ":value:" if entry.takes else ""
        return [quoted(f"*{name}[{meaning}]{value}") for name in entry.names]

    listed = " ".join(quoted(f"{name}:{page.summary.replace(':', ' ')}") for name, page in pages.items() if name)
    cases = "".join(f"    {name}) _arguments {' '.join(word for entry in page.options for word in argument(entry))} '*:file:_files' ;;\n" for name, page in pages.items() if name)
    return f"""#compdef glint
# Completes the words of the command glint in zsh.
_glint() {{
  local state line
  _arguments -C {' '.join(word for entry in pages[''].options for word in argument(entry))} '1:command:->command' '*::argument:->argument'
  case $state in
    command) local -a commands; commands=({listed}); _describe command commands ;;
    argument) case $words[1] in
{cases}    esac ;;
  esac
}}
_glint "$@"
"""


def fish(pages: dict[str, Help]) -> str:
    def quoted(text: str) -> str:
        return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"

    lines = ["# Completes the words of the command glint in fish."]
    for name, page in pages.items():
        when = f"__fish_seen_subcommand_from {name}" if name else "__fish_use_subcommand"
        if name:
            lines.append(f"complete -c glint -n __fish_use_subcommand -f -a {name} -d {quoted(page.summary)}")
        for entry in page.options:
            words = " ".join(f"-l {option[2:]}" if option.startswith("--") else f"-s {option[1:]}" for option in entry.names)
            value = f" -x -a {quoted(' '.join(choices(entry)))}" if choices(entry) else " -r" if entry.takes else ""
            lines.append(f"complete -c glint -n {quoted(when)} {words}{value} -d {quoted(entry.meaning)}")
    return "\n".join(lines) + "\n"


def main() -> None:
    glint, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    pages = help_text.read_all(glint)
    names = [f"glint-{name}" if name else "glint" for name in pages]
    files = {f"man/man1/{own}.1": manual(name, page, [other for other in names if other != own]) for own, (name, page) in zip(names, pages.items())}
    files |= {"bash-completion/completions/glint": bash(pages), "zsh/vendor-completions/_glint": zsh(pages), "fish/vendor_completions.d/glint.fish": fish(pages)}
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)


if __name__ == "__main__":
    main()
