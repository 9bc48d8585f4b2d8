#!/usr/bin/env python3
# Puts all pictures of a `glint bench` directory into one: a row of PT, SH and AO for every scene, two scenes side by side.
# SPDX-License-Identifier: Apache-2.0
"""usage: contact_sheet.py BENCH_DIR OUT.jpg [SIDE]

Each workload's image.png is scaled to SIDE (default 192) pixels and named. The place of a workload that was not run stays dark.
The script needs python3-pil.
"""
import pathlib
import sys

from PIL import Image, ImageDraw, ImageFont

SCENES = ("WKND", "SHIP", "BUNNY", "SPNZA", "CHSNT", "BATH", "REF", "CRNVL", "FOX", "PARTY", "SPRNG", "LANDS", "FRST", "PARK", "CAR", "ROBOT")
SHADERS = ("PT", "SH", "AO")
GAP, LABEL = 4, 16  # pixels
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
GROUND, INK = (24, 26, 30), (214, 214, 214)


def font():
    try:
        return ImageFont.truetype(FONT, 11)
    except OSError:
        return ImageFont.load_default()


def main(bench, out, side=192):
    columns, rows = 2 * len(SHADERS), (len(SCENES) + 1) // 2
    sheet = Image.new("RGB", (columns * (side + GAP) + GAP, rows * (side + GAP + LABEL) + GAP), GROUND)
    draw, letters, found = ImageDraw.Draw(sheet), font(), 0
    for i, scene in enumerate(SCENES):
        for j, shader in enumerate(SHADERS):
            x = GAP + (i % 2 * len(SHADERS) + j) * (side + GAP)
            y = GAP + i // 2 * (side + GAP + LABEL)
            path = pathlib.Path(bench) / f"{scene}_{shader}" / "image.png"
            if not path.exists():
                continue
            found += 1
            with Image.open(path) as picture:
                sheet.paste(picture.convert("RGB").resize((side, side), Image.LANCZOS), (x, y))
            draw.text((x + 2, y + side + 1), f"{scene}_{shader}", INK, letters)
    if not found:
        sys.exit(f"{bench}: no pictures; run 'glint bench' into it first")
    sheet.save(out, quality=85, optimize=True)
    print(f"{out}: {found} pictures")


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], *map(int, sys.argv[3:]))
