# Finds links within the built site that lead nowhere: to pages, pictures and anchors.
# SPDX-License-Identifier: Apache-2.0
"""Reads the HTML that Sphinx wrote; links to other sites are not followed."""
import html.parser
import pathlib
import urllib.parse


class _Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.links, self.anchors = [], set()

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name == "id":
                self.anchors.add(value)
            elif value and (name == "href" or (name == "src" and tag in ("img", "script"))):
                self.links.append(value)


def broken(folder: pathlib.Path) -> list[str]:
    """Returns 'page: link' of every link to a file or an anchor that is not there."""
    pages = {}
    for path in sorted(folder.rglob("*.html")):
        pages[path] = page = _Page()
        page.feed(path.read_text(encoding="utf-8"))
    anchors = {path.resolve(): page.anchors for path, page in pages.items()}
    found = []
    for path, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path.resolve()
            if not target.exists():
                found.append(f"{path.relative_to(folder)}: {link}: no such file")
            elif parts.fragment and target in anchors and urllib.parse.unquote(parts.fragment) not in anchors[target]:
                found.append(f"{path.relative_to(folder)}: {link}: no such anchor")
    return found
