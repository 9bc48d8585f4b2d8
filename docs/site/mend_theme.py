# Puts back into the built site what Debian's package of furo lost. That package is made for a web server and for modules.
# SPDX-License-Identifier: Apache-2.0
"""Adds the reset of margins, the dark scheme by the system's wish, and scripts that run from disk. What is there already stays."""
import pathlib
import re
import shutil

_PACKAGED_RESET = "/javascript/normalize.css/normalize.css"


def mend(static: pathlib.Path) -> None:
    """Changes furo's files in the folder `_static` of the site. Raises RuntimeError when a part is missing."""
    style = static / "styles/furo.css"
    style.write_text(_dark_by_system(_own_reset(style.read_text(encoding="utf-8"), style.parent)), encoding="utf-8")
    script, spy = static / "scripts/furo.js", static / "scripts/gumshoe-patched.js"
    text = script.read_text(encoding="utf-8")
    imported = re.search(r'^import Gumshoe from "[^"]+";\n', text, re.M)
    if imported:  # browsers load no modules from disk
        script.write_text(spy.read_text(encoding="utf-8") + text.replace(imported[0], ""), encoding="utf-8")


def _own_reset(style: str, folder: pathlib.Path) -> str:
    if _PACKAGED_RESET not in style:
        return style
    for place in ("/usr/share/nodejs/normalize.css", "/usr/share/javascript/normalize.css"):
        reset = pathlib.Path(place) / "normalize.css"
        if reset.is_file():
            shutil.copy(reset, folder / "normalize.css")
            return style.replace(_PACKAGED_RESET, "normalize.css")
    raise RuntimeError("furo's style needs normalize.css, which is not there: install node-normalize.css")


def _dark_by_system(style: str) -> str:
    """Adds the rules for `auto`, which Debian's style compiler drops. They are those of `dark`, behind a question to the system."""
    if "prefers-color-scheme" in style:
        return style
    dark = re.search(r'body\[data-theme="dark"\] \{([^}]*)\}', style)
    if not dark:
        raise RuntimeError("furo's style has no dark scheme: this version of the theme is not known to docs/site/mend_theme.py")
    auto = 'body:not([data-theme="light"])'
    icon = 'body[data-theme="auto"] .theme-toggle svg'
    return style + f"""
@media not print {{ @media (prefers-color-scheme: dark) {{ {auto} {{{dark[1]}}}
  html {auto} .only-light {{ display: none !important; }} {auto} .only-dark {{ display: block !important; }} }} }}
{icon}.theme-icon-when-auto {{ display: block; }}
"""
