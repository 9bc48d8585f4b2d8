# Configures the documentation site: Sphinx with MyST and the theme furo. docs/build runs it on a copy of docs/.
# SPDX-License-Identifier: Apache-2.0
"""Sphinx reads this file. Nothing here is fetched from a network."""
import pathlib
import re

import mend_theme

project = "Glint"
author = "the Glint project"
copyright = "the Glint project, Apache-2.0"  # noqa: A001 (the name is Sphinx's)
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence"]
exclude_patterns = ["README.md", "site"]
highlight_language = "none"
nitpicky = False
html_theme = "furo"
html_title = "Glint"
html_static_path = ["static"]
html_css_files = ["glint.css"]
html_show_sourcelink = False
html_copy_source = False
html_show_search_summary = False  # it would fetch every page found, which a browser refuses from disk
smartquotes = False  # `--option` in a text stays as it is written
html_last_updated_fmt = None  # the same input gives the same pages
autodoc_typehints = "signature"
autodoc_member_order = "bysource"
python_use_unqualified_type_names = True
default_role = "literal"  # of docstrings: `name` is code
napoleon_use_rtype = False
napoleon_use_ivar = True
html_theme_options = {
    "sidebar_hide_name": False,
    "light_css_variables": {"color-brand-primary": "#0072B2", "color-brand-content": "#0072B2"},
    "dark_css_variables": {"color-brand-primary": "#56B4E9", "color-brand-content": "#56B4E9"},
}


def _outside(app, docname, source):
    """Turns links that leave docs/ into the path as code, because the site holds no copy of the sources."""
    folder = pathlib.PurePosixPath(docname).parent

    def shown(match):
        up = len([part for part in match[2].split("/") if part == ".."])
        inside = up <= len(folder.parts) if str(folder) != "." else up == 0
        path = match[2].replace("../", "")
        return match[0] if inside else (f"`{path}`" if match[1].strip("`").strip("/") in path else f"{match[1]} (`{path}`)")

    source[0] = re.sub(r"(?<!!)\[([^\]]*)\]\(((?:\.\./)+[^)#]+)(?:#[^)]*)?\)", shown, source[0])


def _from_disk(app, error):
    """Makes pages work from disk, light and dark, also with Debian's package of the theme."""
    if not error:
        mend_theme.mend(pathlib.Path(app.outdir) / "_static")


def setup(app):
    app.connect("source-read", _outside)
    app.connect("build-finished", _from_disk)
