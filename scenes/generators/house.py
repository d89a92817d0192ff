"""A small half-timbered house, our own, in metres: y upwards, its front towards +z.

No two faces lie in one plane: posts stand out further than rails, and rails further than braces.
"""
from generators.mesh import box_lines, cross, face_lines, unit

WIDTH, DEPTH = 5.2, 4.0  # of the upper floor; the lower one is narrower all around
OVERHANG = 0.25
SILL, FLOOR, EAVES, RIDGE = 0.4, 2.5, 4.7, 7.4

MATERIALS = """\
# Written by scenes/make_scenes.py
newmtl plaster
Kd 0.8 0.76 0.66

newmtl timber
Kd 0.16 0.1 0.06

newmtl stone
Kd 0.42 0.4 0.38

newmtl roof
Kd 1 1 1
map_Kd tiles.png

newmtl pane
Kd 0.05 0.07 0.09

newmtl door
Kd 0.3 0.16 0.07

newmtl ground
Kd 0.28 0.33 0.16
"""


def block(material, low, high):
    size = [b - a for a, b in zip(low, high)]
    return [f"usemtl {material}"] + box_lines(low, (size[0], 0, 0), (0, size[1], 0), (0, 0, size[2]))


def beam(start, end, outward, width, out):
    """A bar from start to end on a wall, sunk into it by 5 cm and standing out from it."""
    along = [b - a for a, b in zip(start, end)]
    side = [width * x for x in cross(unit(along), outward)]  # along x outward = side, so side x along = outward
    depth = [(out + 0.05) * x for x in outward]
    origin = [s - 0.5 * x - 0.05 * o for s, x, o in zip(start, side, outward)]
    return ["usemtl timber"] + box_lines(origin, side, along, depth)


def wall(left, right, outward, low, high, openings):
    """The timbers of a wall from `left` to `right` at two heights, with windows at fractions of its length."""
    def at(fraction, height):
        return (left[0] + fraction * (right[0] - left[0]), height, left[1] + fraction * (right[1] - left[1]))

    lines = []
    for height in (low + 0.09, high - 0.09):
        lines += beam(at(0, height), at(1, height), outward, 0.17, 0.04)
    posts = [0.02, 0.25, 0.5, 0.75, 0.98]
    for fraction in posts:
        lines += beam(at(fraction, low), at(fraction, high), outward, 0.15, 0.055)
    lines += beam(at(0.02, low + 0.15), at(0.25, high - 0.15), outward, 0.12, 0.03)
    lines += beam(at(0.98, low + 0.15), at(0.75, high - 0.15), outward, 0.12, 0.025)
    for first, last in openings:
        bottom, top = low + 0.75, high - 0.45
        middle = 0.5 * (first + last)
        lines += ["usemtl pane"]
        pane = [at(first, bottom), at(last, bottom), at(last, top), at(first, top)]
        lines += face_lines([[c + 0.02 * o for c, o in zip(corner, outward)] for corner in pane])
        for height in (bottom, top):
            lines += beam(at(first, height), at(last, height), outward, 0.1, 0.065)
        lines += beam(at(middle, bottom), at(middle, top), outward, 0.05, 0.05)
    return lines


def floor_lines(half_width, half_depth, low, high, front):
    w, d = half_width, half_depth
    lines = block("plaster", (-w, low, -d), (w, high, d))
    lines += wall((-w, d), (w, d), (0, 0, 1), low, high, front)
    lines += wall((w, d), (w, -d), (1, 0, 0), low, high, [(0.28, 0.47), (0.53, 0.72)])
    lines += wall((w, -d), (-w, -d), (0, 0, -1), low, high, [])
    return lines + wall((-w, -d), (-w, d), (-1, 0, 0), low, high, [(0.53, 0.72)])


def roof_lines():
    w, d = WIDTH / 2, DEPTH / 2
    lines = ["usemtl plaster"]  # the gables
    lines += face_lines([(w, EAVES, d), (w, EAVES, -d), (w, RIDGE, 0)])
    lines += face_lines([(-w, EAVES, -d), (-w, EAVES, d), (-w, RIDGE, 0)])
    for x, outward in ((w, (1, 0, 0)), (-w, (-1, 0, 0))):
        lines += beam((x, EAVES, 0), (x, RIDGE - 0.1, 0), outward, 0.15, 0.055)
        for z in (d - 0.25, 0.25 - d):
            lines += beam((x, EAVES + 0.1, z), (x, RIDGE - 0.9, 0.12 * z), outward, 0.13, 0.03)
        lines += beam((x, EAVES + 1.1, 0.55 * d), (x, EAVES + 1.1, -0.55 * d), outward, 0.13, 0.04)
    out, drop, thickness = 0.35, 0.35, 0.14
    slope = (RIDGE - EAVES) / d
    for side in (1, -1):
        edge = [(-w - out, EAVES - drop * slope, side * (d + drop)), (w + out, EAVES - drop * slope, side * (d + drop))]
        ridge = [(w + out, RIDGE, 0), (-w - out, RIDGE, 0)]
        lower = edge + ridge if side > 0 else [edge[1], edge[0], ridge[1], ridge[0]]
        upper = [(x, y + thickness, z) for x, y, z in lower]
        lines += ["usemtl roof"] + face_lines(upper, [(0, 0), (6, 0), (6, 4), (0, 4)])
        lines += ["usemtl timber"] + face_lines(lower[::-1])
        for i in (0, 1, 3):  # the fourth edge is the ridge
            lines += face_lines([lower[i], lower[(i + 1) % 4], upper[(i + 1) % 4], upper[i]])
    return lines


def lines():
    text = ["# A half-timbered house. Written by scenes/make_scenes.py. Metres, y upwards.", "mtllib house.mtl"]
    w, d = WIDTH / 2 - OVERHANG, DEPTH / 2 - OVERHANG
    text += ["o ground", "usemtl ground"] + face_lines([(-30, 0, 30), (30, 0, 30), (30, 0, -30), (-30, 0, -30)])
    text += ["o base"] + block("stone", (-w - 0.1, -0.2, -d - 0.1), (w + 0.1, SILL + 0.003, d + 0.1))
    text += ["o ground_floor"] + floor_lines(w, d, SILL, FLOOR + 0.01, [(0.06, 0.2), (0.78, 0.94)])
    text += ["o upper_floor"] + floor_lines(WIDTH / 2, DEPTH / 2, FLOOR, EAVES, [(0.06, 0.21), (0.29, 0.46), (0.54, 0.71), (0.79, 0.94)])
    text += ["o door"] + block("door", (-0.45, 0.12, d), (0.45, 2.1, d + 0.07))
    text += block("stone", (-0.75, -0.2, d + 0.02), (0.75, 0.2, d + 0.7))
    text += ["o roof"] + roof_lines()
    text += ["o chimney"] + block("stone", (1.2, 5.2, -1.1), (1.8, 8.1, -0.5))
    return text


def tile_texels(side):
    """Rows of roof tiles, each a little different, darker towards their upper end and between them: r, g, b."""
    rows = []
    tile = side // 4
    for row in range(side):
        texels = []
        for column in range(side):
            course = row // tile
            shifted = (column + (course % 2) * tile // 2) % side
            kind = (shifted // tile * 7 + course * 5) % 6
            across, along = shifted % tile, row % tile
            shade = 0.75 + 0.25 * along / tile + 0.03 * kind
            if across < 2 or along < 2:
                shade *= 0.45
            texels.append(tuple(min(255, round(255 * shade * c)) for c in (0.62, 0.3 + 0.012 * kind, 0.2)))
        rows.append(texels)
    return rows
