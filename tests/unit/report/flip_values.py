# FLIP worked out from the formulas of Andersson et al. 2020 in the plainest way: what flip_test.cpp compares with.
# SPDX-License-Identifier: Apache-2.0
"""usage: flip_values.py > flip_values.csv

Two-dimensional kernels, summed pixel by pixel; the matrix to XYZ in fractions. Nothing here is shared with report/picture/flip.cpp.
Columns: pair of pictures, pixels per degree, x, y, FLIP; the row with x = -1 has the mean.
"""
import math
from fractions import Fraction

WIDTH, HEIGHT = 20, 14


def pair(name):
    """Returns two pictures, [y][x] -> (r, g, b), that flip_test.cpp makes by the same rules."""
    def noise(x, y, c, seed):
        return ((x * 37 + y * 101 + c * 53 + x * y * 7 + seed * 71) % 97) / 96

    def make(pixel):
        return [[pixel(x, y) for x in range(WIDTH)] for y in range(HEIGHT)]
    if name == "noise":
        return tuple(make(lambda x, y, s=seed: tuple(noise(x, y, c, s) for c in range(3))) for seed in (1, 2))
    if name == "edge":
        return tuple(make(lambda x, y, e=edge: (0.75,) * 3 if x >= e else (0.25,) * 3) for edge in (9, 11))
    if name == "hue":
        return make(lambda x, y: (1, 0, 0)), make(lambda x, y: (0, 1, 0) if 6 <= x < 13 and 4 <= y < 9 else (1, 0, 0))
    return make(lambda x, y: (0, 0, 0)), make(lambda x, y: (1, 1, 1))


def matrix():
    """Returns the matrix from linear RGB to XYZ from the chromaticities of primaries and white, in fractions: column i is primary i times its share."""
    xy = [(64, 33), (30, 60), (15, 6)]
    columns = [[Fraction(x, y), Fraction(1), Fraction(100 - x - y, y)] for x, y in xy]
    white = [Fraction(3127, 3290), Fraction(1), Fraction(10000 - 3127 - 3290, 3290)]
    rows = [[columns[i][r] for i in range(3)] + [white[r]] for r in range(3)]
    for i in range(3):  # Gauss and Jordan
        rows[i] = [v / rows[i][i] for v in rows[i]]
        for r in range(3):
            if r != i:
                rows[r] = [a - rows[r][i] * b for a, b in zip(rows[r], rows[i])]
    shares = [rows[i][3] for i in range(3)]
    return [[float(columns[i][r] * shares[i]) for i in range(3)] for r in range(3)], [float(v) for v in white]


TO_XYZ, WHITE = matrix()


def solve(v):
    """Returns TO_XYZ^-1 v, by Cramer's rule."""
    def det(m):
        return (m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
                + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]))
    whole = det(TO_XYZ)
    return [det([[v[r] if c == i else TO_XYZ[r][c] for c in range(3)] for r in range(3)]) / whole for i in range(3)]


def linear(v):
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def xyz(rgb):
    return [sum(m * v for m, v in zip(row, rgb)) for row in TO_XYZ]


def ycc(rgb):
    x, y, z = (v / w for v, w in zip(xyz(rgb), WHITE))
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


def lab(rgb):
    def f(t):
        return t ** (1 / 3) if t > (6 / 29) ** 3 else t / (3 * (6 / 29) ** 2) + 4 / 29
    x, y, z = (f(v / w) for v, w in zip(xyz(rgb), WHITE))
    light = 116 * y - 16
    return light, 0.01 * light * 500 * (x - y), 0.01 * light * 200 * (y - z)


def hyab(a, b):
    return abs(a[0] - b[0]) + math.sqrt((a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)


def convolve(plane, kernel):
    r = len(kernel) // 2

    def at(x, y):
        return plane[min(max(y, 0), HEIGHT - 1)][min(max(x, 0), WIDTH - 1)]
    return [[sum(kernel[j + r][i + r] * at(x + i, y + j) for j in range(-r, r + 1) for i in range(-r, r + 1)) for x in range(WIDTH)] for y in range(HEIGHT)]


def seen(plane, channel, ppd):
    a1, b1, a2, b2 = {0: (1, 0.0047, 0, 1e-5), 1: (1, 0.0053, 0, 1e-5), 2: (34.1, 0.04, 13.5, 0.025)}[channel]
    r = math.ceil(3 * math.sqrt(0.04 / (2 * math.pi ** 2)) * ppd)

    def weight(i, j):
        d = (i * i + j * j) / ppd ** 2
        return a1 * math.sqrt(math.pi / b1) * math.exp(-math.pi ** 2 * d / b1) + a2 * math.sqrt(math.pi / b2) * math.exp(-math.pi ** 2 * d / b2)
    kernel = [[weight(i, j) for i in range(-r, r + 1)] for j in range(-r, r + 1)]
    whole = sum(map(sum, kernel))
    return convolve(plane, [[v / whole for v in row] for row in kernel])


def feature(plane, ppd, second):
    sigma = 0.5 * 0.082 * ppd
    r = math.ceil(3 * sigma)

    def weight(i, j):
        return (i * i / sigma ** 2 - 1 if second else -i) * math.exp(-(i * i + j * j) / (2 * sigma ** 2))
    kernel = [[weight(i, j) for i in range(-r, r + 1)] for j in range(-r, r + 1)]
    above = sum(v for row in kernel for v in row if v > 0)
    below = -sum(v for row in kernel for v in row if v < 0)
    kernel = [[v / (above if v > 0 else below) for v in row] for row in kernel]
    across, down = convolve(plane, kernel), convolve(plane, [list(c) for c in zip(*kernel)])
    return [[math.hypot(a, d) for a, d in zip(*rows)] for rows in zip(across, down)]


def look(picture, ppd):
    """Returns Lab of each pixel as seen, edges and points."""
    c = [[ycc([linear(v) for v in rgb]) for rgb in row] for row in picture]
    planes = [seen([[v[i] for v in row] for row in c], i, ppd) for i in range(3)]

    def color(x, y):
        yy, cx, cz = (p[y][x] for p in planes)
        level = (yy + 16) / 116
        rgb = solve([(level + cx / 500) * WHITE[0], level * WHITE[1], (level - cz / 200) * WHITE[2]])
        return lab([min(max(v, 0), 1) for v in rgb])
    grey = [[(v[0] + 16) / 116 for v in row] for row in c]
    return [[color(x, y) for x in range(WIDTH)] for y in range(HEIGHT)], feature(grey, ppd, False), feature(grey, ppd, True)


def flip(name, ppd):
    (la, ea, pa), (lb, eb, pb) = (look(p, ppd) for p in pair(name))
    most = hyab(lab([0, 1, 0]), lab([0, 0, 1])) ** 0.7

    def at(x, y):
        d = hyab(la[y][x], lb[y][x]) ** 0.7
        color = 0.95 * d / (0.4 * most) if d < 0.4 * most else 0.95 + 0.05 * (d - 0.4 * most) / (0.6 * most)
        detail = (max(abs(ea[y][x] - eb[y][x]), abs(pa[y][x] - pb[y][x])) / math.sqrt(2)) ** 0.5
        return color ** (1 - detail)
    return [[at(x, y) for x in range(WIDTH)] for y in range(HEIGHT)]


def main():
    print("pair,ppd,x,y,flip")
    for name, ppd in (("noise", 67), ("edge", 67), ("hue", 67), ("ends", 67), ("noise", 20), ("edge", 30)):
        values = flip(name, ppd)
        print(f"{name},{ppd},-1,0,{sum(map(sum, values)) / (WIDTH * HEIGHT):.9f}")
        for y in range(0, HEIGHT, 3):
            for x in range(0, WIDTH, 4):
                print(f"{name},{ppd},{x},{y},{values[y][x]:.9f}")


main()
