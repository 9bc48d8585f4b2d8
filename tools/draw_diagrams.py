#!/usr/bin/env python3
# Draws the diagrams of docs/concepts.md as SVG. They are legible on light and dark pages, and text stays text.
# SPDX-License-Identifier: Apache-2.0
"""usage: tools/draw_diagrams.py [FOLDER], by default docs/images"""
import html
import pathlib
import sys

# Each picture has its own background, so background and ink both follow the system's colour scheme, whatever the page's is.
STYLE = """
.ground{fill:#ffffff;stroke:#d3d7dc}.ink,text{fill:#1b2026}.muted{fill:#5c6672}.line{stroke:#5c6672;fill:none}
.head{fill:#5c6672}.box{fill:#f4f6f8;stroke:#8a929c}.blue{fill:#cfe5f3;stroke:#0072b2}.green{fill:#cdebe1;stroke:#009e73}
.orange{fill:#fbe8c4;stroke:#c98700}.pink{fill:#f3dfea;stroke:#b05c8c}.off{fill:none;stroke:#c3c8ce}.on{fill:#0072b2;stroke:#0072b2}
@media(prefers-color-scheme:dark){.ground{fill:#14181d;stroke:#3c434c}.ink,text{fill:#e8ebef}.muted{fill:#9aa4b0}
.line{stroke:#9aa4b0}.head{fill:#9aa4b0}.box{fill:#1f252c;stroke:#868e98}.blue{fill:#123c56;stroke:#2e8fcb}
.green{fill:#0f4737;stroke:#1db58a}.orange{fill:#4d3a0d;stroke:#e69f00}.pink{fill:#4a2f3e;stroke:#cc79a7}
.off{stroke:#3c434c}.on{fill:#2e8fcb;stroke:#2e8fcb}}
text{font:13px system-ui,-apple-system,"Segoe UI",Roboto,Arial,sans-serif}.small{font-size:11px}.code{font-family:ui-monospace,monospace;font-size:12px}
.line{stroke-width:1.3}rect,circle{stroke-width:1.2}
"""


class Drawing:
    """Collects the shapes of one picture. x goes to the right and y down, in pixels."""

    def __init__(self, width, height, title):
        self.size, self.title, self.parts = (width, height), title, []

    def text(self, x, y, words, kind="", anchor="middle"):
        self.parts.append(f'<text x="{x}" y="{y}" class="{kind}" text-anchor="{anchor}">{html.escape(words)}</text>')

    def box(self, x, y, w, h, words, kind="box", note=""):
        """Draws a box with a line of text, and a smaller line below it."""
        self.parts.append(f'<rect x="{x}" y="{y}" width="{w}" height="{h}" rx="5" class="{kind}"/>')
        middle = y + h / 2 + 4.5
        self.text(x + w / 2, middle - (7 if note else 0), words)
        if note:
            self.text(x + w / 2, middle + 9, note, "small muted")

    def frame(self, x, y, w, h, words):
        """Draws an empty box with its name at the top left."""
        self.parts.append(f'<rect x="{x}" y="{y}" width="{w}" height="{h}" rx="7" class="line" stroke-dasharray="4 3"/>')
        self.text(x + 9, y + 17, words, "small muted", "start")

    def arrow(self, points, words="", at=None, kind="small muted", anchor="middle"):
        """Draws a line through the points with a head at its end, and words at `at`."""
        way = " ".join(f"{x},{y}" for x, y in points)
        self.parts.append(f'<polyline points="{way}" class="line" marker-end="url(#head)"/>')
        if words:
            (x0, y0), (x1, y1) = points[0], points[-1]
            x, y = at or ((x0 + x1) / 2, (y0 + y1) / 2 - 6)
            self.text(x, y, words, kind, anchor)

    def lanes(self, x, y, mask, size=15):
        """Draws a square for each lane, filled where the lane is active."""
        for i, active in enumerate(mask):
            self.parts.append(f'<rect x="{x + i * (size + 3)}" y="{y}" width="{size}" height="{size}" rx="2" class="{"on" if active == "1" else "off"}"/>')

    def svg(self):
        width, height = self.size
        head = '<defs><marker id="head" markerWidth="9" markerHeight="8" refX="7.5" refY="4" orient="auto"><path class="head" d="M0,0L8,4L0,8z"/></marker></defs>'
        body = "\n".join(self.parts)
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img">\n'
                f"<title>{html.escape(self.title)}</title>\n<style>{STYLE}</style>{head}\n"
                f'<rect class="ground" x="0.5" y="0.5" width="{width - 1}" height="{height - 1}" rx="9"/>\n{body}\n</svg>\n')


def simt():
    """Shows a branch that splits a warp: which lanes execute what, and what the stack holds."""
    d = Drawing(760, 292, "A warp of eight lanes at a branch, and its SIMT stack")
    for x, words in ((24, "instruction"), (228, "lanes (8 of 32 drawn)"), (420, "SIMT stack after it, top first")):
        d.text(x, 30, words, "small muted", "start")
    rows = [("ssy JOIN", "11111111", "Join JOIN: none has come"),
            ("@p0 bra ELSE", "11111111", "Path ELSE: 00101001 wait | Join JOIN: none"),
            ("mul.f32 ...", "11010110", "Path ELSE: 00101001 wait | Join JOIN: none"),
            ("join", "11010110", "Path ELSE: 00101001 wait | Join JOIN: 11010110"),
            ("ELSE: add.f32 ...", "00101001", "Join JOIN: 11010110"),
            ("join", "00101001", "Join JOIN: 11111111, all: popped"),
            ("JOIN: st.global ...", "11111111", "(empty)")]
    for i, (code, mask, stack) in enumerate(rows):
        y = 44 + 31 * i
        d.text(24, y + 13, code, "code", "start")
        d.lanes(228, y, mask)
        d.text(420, y + 13, stack, "small", "start")
    d.text(24, 278, "Both sides of a divergent branch are executed, one after another: four instructions of the seven leave lanes idle.", "small muted", "start")
    return d


def rt_unit():
    """Shows a ray's way through the RT unit."""
    d = Drawing(760, 350, "The RT unit: from rt.trace to the hit")
    d.box(20, 50, 118, 58, "core", "blue", "rt.trace of a warp")
    d.frame(178, 22, 562, 244, "RT unit (one per core)")
    d.box(198, 50, 150, 58, "warp buffer", "box", "rt.warps slots of 32 rays")
    d.box(390, 50, 150, 58, "scheduler", "box", "rt.scheduler")
    d.box(580, 50, 142, 58, "request port", "box", "rt.coalescing")
    d.box(580, 292, 142, 44, "L1 cache", "orange")
    d.box(390, 182, 150, 64, "tests", "green", "box, triangle, transform")
    d.box(198, 182, 150, 64, "stack of each ray", "box", "rt.stack, rt.child_order")
    d.arrow([(138, 72), (196, 72)])
    d.arrow([(348, 79), (388, 79)])
    d.arrow([(540, 79), (578, 79)])
    d.arrow([(668, 108), (668, 290)], "nodes", (690, 205))
    d.arrow([(634, 292), (634, 214), (542, 214)], "answers", (610, 232), anchor="middle")
    d.arrow([(390, 214), (350, 214)])
    d.arrow([(273, 182), (273, 110)], "next node", (280, 150), anchor="start")
    d.arrow([(198, 96), (140, 96)])
    d.text(159, 122, "done", "small muted")
    d.arrow([(198, 232), (79, 232), (79, 110)])
    d.text(24, 250, "any-hit, intersection:", "small muted", "start")
    d.text(24, 265, "the core runs the shader,", "small muted", "start")
    d.text(24, 280, "the ray goes on after it", "small muted", "start")
    return d


def memory():
    """Shows the way from cores to DRAM."""
    d = Drawing(760, 330, "The memory path: L1, network, L2 slices, DRAM channels")
    for i, name in enumerate(("core 0", "core 1", "core 7")):
        x = 40 + i * 180 + (60 if i == 2 else 0)
        d.box(x, 24, 140, 40, name, "blue", "shaders and RT unit")
        d.box(x, 84, 140, 44, "L1", "orange", "128 B lines of 4 sectors")
        d.arrow([(x + 70, 64), (x + 70, 82)])
        d.arrow([(x + 52, 128), (x + 52, 156)])
        d.arrow([(x + 88, 158), (x + 88, 130)])
    d.text(394, 110, "...")
    d.box(40, 158, 560, 36, "network: a port each way, bytes per cycle, latency", "box")
    for i, name in enumerate(("partition 0", "partition 1", "partition 3")):
        x = 40 + i * 180 + (60 if i == 2 else 0)
        d.arrow([(x + 52, 194), (x + 52, 220)])
        d.arrow([(x + 88, 222), (x + 88, 196)])
        d.box(x, 222, 140, 44, "L2 slice", "orange", name)
        d.box(x, 280, 140, 36, "DRAM channel", "pink")
        d.arrow([(x + 70, 266), (x + 70, 278)])
    d.text(394, 246, "...")
    for y, words in ((40, "requests by class:"), (56, "rt_node, shader_global"), (102, "memory.l1.*"), (118, "MSHRs, ports, banks"),
                     (180, "memory.noc.*"), (240, "memory.l2.*"), (256, "memory.hash"), (302, "memory.dram.*")):
        d.text(620, y, words, "small muted", "start")
    return d


def node(d, x, y, words, kind):
    d.parts.append(f'<circle cx="{x}" cy="{y}" r="15" class="{kind}"/>')
    d.text(x, y + 4, words, "small")


def bvh():
    """Shows two levels of boxes: instances of structures, structures of triangles."""
    d = Drawing(760, 356, "A two-level acceleration structure")
    d.frame(20, 16, 720, 140, "top level: boxes around instances; rays in world space")
    d.frame(20, 190, 440, 152, "")
    d.frame(480, 190, 260, 152, "")
    d.text(29, 333, "bottom level \"tree\": boxes around triangles; rays in its own space", "small muted", "start")
    d.text(489, 333, "bottom level \"ground\"", "small muted", "start")
    for x0, y0, x1, y1 in ((380, 48, 236, 92), (380, 48, 560, 92), (236, 92, 150, 134), (236, 92, 300, 134),
                           (240, 222, 150, 258), (240, 222, 330, 258), (150, 258, 110, 296), (150, 258, 190, 296), (330, 258, 290, 296), (330, 258, 370, 296),
                           (610, 222, 560, 270), (610, 222, 660, 270)):
        d.parts.append(f'<line x1="{x0}" y1="{y0}" x2="{x1}" y2="{y1}" class="line"/>')
    for x, y in ((380, 48), (236, 92), (240, 222), (150, 258), (330, 258), (610, 222)):
        node(d, x, y, "box", "blue")
    for x, words in ((150, "instance 0"), (300, "instance 1"), (560, "instance 2")):
        y = 134 if x != 560 else 92
        d.box(x - 46, y - 14, 92, 27, words, "green")
    for x, y in ((110, 296), (190, 296), (290, 296), (370, 296), (560, 270), (660, 270)):
        d.parts.append(f'<path d="M{x},{y - 13}l14,24h-28z" class="orange"/>')
    d.arrow([(150, 148), (222, 206)], "transform", (120, 178))
    d.arrow([(300, 148), (256, 206)], "transform", (326, 178))
    d.arrow([(560, 106), (604, 204)], "transform", (628, 168))
    return d


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[1] / "docs/images"
    for picture in (simt, rt_unit, memory, bvh):
        (folder / f"{picture.__name__}.svg").write_text(picture().svg())
        print(f"wrote {folder / picture.__name__}.svg")


if __name__ == "__main__":
    main()
