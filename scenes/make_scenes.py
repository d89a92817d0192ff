#!/usr/bin/env python3
"""Writes the meshes, images and large descriptions of the scenes beside this script; the small descriptions (.json) are
written by hand.

Cornell box: room, light and blocks are the measured data of the Cornell Program of Computer Graphics,
https://www.graphics.cornell.edu/online/box/data.html (1998), in millimetres. The reflectances and the emission are the
RGB values in which renderers usually express its measured spectra (for example McGuire's Computer Graphics Archive).

So that no two faces coincide and no edge ends inside another one, the ceiling has a hole where the light is, the room
shares its corners, and the blocks have no bottom. The faces of the room look inwards, those of the blocks outwards.

Foliage: our own, in metres. Leaves and a fence are cards whose shapes are textures; a sail lets part of the light pass.
"""
import math
import pathlib
import random
import struct
import zlib

from generators import house, knot, sky, weekend
from generators.mesh import number, unit

SOURCE = [
    "# The Cornell box, from the measured data at https://www.graphics.cornell.edu/online/box/data.html",
    "# Millimetres, y upwards, open towards -z. Written by scenes/make_scenes.py, which says what was cleaned up.",
]
ROOM_VERTICES = [
    (552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2),
    (556, 548.8, 0), (0, 548.8, 0), (0, 548.8, 559.2), (556, 548.8, 559.2),
    (343, 548.8, 227), (213, 548.8, 227), (213, 548.8, 332), (343, 548.8, 332),
]
# object, material, faces
ROOM = [
    ("floor", "white", [(1, 2, 3, 4)]),
    ("back_wall", "white", [(4, 3, 7, 8)]),
    ("ceiling", "white", [(5, 8, 12, 9), (8, 7, 11, 12), (7, 6, 10, 11), (6, 5, 9, 10)]),
    ("right_wall", "green", [(3, 2, 6, 7)]),
    ("left_wall", "red", [(1, 4, 8, 5)]),
    ("light", "light", [(9, 12, 11, 10)]),
]
BLOCKS = [
    ("short_block", 165, [(130, 65), (82, 225), (240, 272), (290, 114)]),
    ("tall_block", 330, [(423, 247), (265, 296), (314, 456), (472, 406)]),
]
ROOM_MATERIALS = """\
# RGB of the measured spectra of https://www.graphics.cornell.edu/online/box/data.html
newmtl white
Kd 0.725 0.71 0.68
illum 1

newmtl green
Kd 0.14 0.45 0.091
illum 1

newmtl red
Kd 0.63 0.065 0.05
illum 1

newmtl light
Kd 0.78 0.78 0.78
Ke 17 12 4
illum 1
"""
SPHERE_MATERIALS = """
newmtl mirror
Kd 0 0 0
Ks 0.95 0.95 0.95
illum 5

newmtl glass
Kd 0 0 0
Tf 1 1 1
Ni 1.5
illum 7
"""
RADIUS = 100
# They hang half a millimetre above the floor: a sphere that touches it would meet it in a vertex.
SPHERES = [("mirror_sphere", "mirror", (388, 100.5, 370)), ("glass_sphere", "glass", (168, 100.5, 190))]
SUBDIVISIONS = 4  # 20 * 4**4 triangles


def room_lines(mtl, material_by_object=False):
    lines = SOURCE + [f"mtllib {mtl}"]
    lines += [f"v {x:g} {y:g} {z:g}" for x, y, z in ROOM_VERTICES]
    for name, material, faces in ROOM:
        material = name if material_by_object else material
        lines += [f"o {name}", f"usemtl {material}"]
        lines += ["f " + " ".join(map(str, face)) for face in faces]
    return lines


def block_lines(material_by_object=False):
    lines = []
    for name, height, corners in BLOCKS:
        assert signed_area(corners) < 0, "the top must look up"
        lines += [f"o {name}", f"usemtl {name if material_by_object else 'white'}"]
        lines += [f"v {x:g} {height:g} {z:g}" for x, z in corners]
        lines += [f"v {x:g} 0 {z:g}" for x, z in corners]
        lines.append("f -8 -7 -6 -5")
        lines += [f"f {i - 8} {i - 4} {(i + 1) % 4 - 4} {(i + 1) % 4 - 8}" for i in range(4)]
    return lines


def signed_area(corners):
    """In the (x, z) plane; negative when the corners run counter-clockwise seen from above (+y), where z points down."""
    return sum(x0 * z1 - x1 * z0 for (x0, z0), (x1, z1) in zip(corners, corners[1:] + corners[:1])) / 2


def icosphere(subdivisions):
    """Unit directions and outward triangles: an icosahedron, each triangle split into four again and again."""
    golden = (1 + math.sqrt(5)) / 2
    points = [(-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0), (0, -1, golden), (0, 1, golden),
              (0, -1, -golden), (0, 1, -golden), (golden, 0, -1), (golden, 0, 1), (-golden, 0, -1), (-golden, 0, 1)]
    points = [unit(p) for p in points]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
                 (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11),
                 (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(subdivisions):
        middles = {}

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(points)
                points.append(unit(tuple(p + q for p, q in zip(points[a], points[b]))))
            return middles[key]

        split = []
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            split += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = split
    return points, triangles


def sphere_lines():
    points, triangles = icosphere(SUBDIVISIONS)
    lines = ["# Normals of both spheres"]
    lines += ["vn " + " ".join(number(x, 6) for x in point) for point in points]
    first = len(ROOM_VERTICES) + 1
    for name, material, centre in SPHERES:
        lines += [f"o {name}", f"usemtl {material}"]
        lines += ["v " + " ".join(number(c + RADIUS * x, 4) for c, x in zip(centre, point)) for point in points]
        lines += ["f " + " ".join(f"{first + i}//{i + 1}" for i in triangle) for triangle in triangles]
        first += len(points)
    return lines


FOLIAGE_MATERIALS = """\
# Written by scenes/make_scenes.py
newmtl ground
Kd 0.5 0.45 0.4

newmtl leaf
Kd 0.12 0.4 0.08
map_d leaf.png

newmtl fence
Kd 0.3 0.2 0.12
map_d fence.png

newmtl sail
Kd 0.8 0.25 0.15
d 0.6

newmtl lamp
Kd 0 0 0
Ke 12 11 9
"""


def card(material, centre, u, v, repeats=(1, 1)):
    """A parallelogram around a centre with the half sides u and v, whose texture repeats."""
    corners = [tuple(c + i * a + j * b for c, a, b in zip(centre, u, v)) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    lines = [f"usemtl {material}"]
    lines += ["v " + " ".join(number(x, 4) for x in corner) for corner in corners]
    lines += [f"vt {s} {t}" for s, t in ((0, 0), (repeats[0], 0), repeats, (0, repeats[1]))]
    return lines + ["f -4/-4 -3/-3 -2/-2 -1/-1"]


def foliage_lines():
    source = random.Random(7)
    lines = ["# Written by scenes/make_scenes.py. Metres, y upwards.", "mtllib foliage.mtl"]
    lines += ["o ground"] + card("ground", (0, 0, 0), (4, 0, 0), (0, 0, -4))
    lines += ["o wall"] + card("ground", (0, 1.9, -3), (4, 0, 0), (0, 1.85, 0))
    lines += ["o lamp"] + card("lamp", (0.6, 3.4, 0.4), (0.4, 0, 0), (0, 0, 0.4))
    lines += ["o fence"] + card("fence", (-0.9, 0.61, -1), (1.6, 0, 0.3), (0, 0.6, 0), (16, 6))
    lines += ["o sail"] + card("sail", (1.7, 1.5, -1.6), (1, 0, 0.5), (0.2, 0.9, 0.3))
    lines.append("o leaves")
    for _ in range(60):
        centre = (source.uniform(-1, 1.4), source.uniform(0.9, 2.4), source.uniform(-0.8, 1))
        along = unit([source.gauss(0, 1) for _ in range(3)])
        other = unit([source.gauss(0, 1) for _ in range(3)])
        dot = sum(a * b for a, b in zip(along, other))
        across = unit([b - dot * a for a, b in zip(along, other)])
        lines += card("leaf", centre, [0.14 * x for x in across], [0.26 * x for x in along])
    return lines


def leaf_texels(side):
    """Opaque inside two arcs that meet at the ends of the card, with a soft edge and a stalk."""
    rows = []
    for row in range(side):
        y = 1 - (2 * row + 1) / side
        row_texels = []
        for column in range(side):
            x = abs((2 * column + 1) / side - 1)
            edge = 0.9 * (1 - y * y) ** 0.75 * (0.8 - 0.25 * y) - x
            opacity = min(max(0.5 + edge * side / 4, 0), 1)
            if y < -0.6 and x < 0.06:
                opacity = 1
            row_texels.append(round(255 * opacity))
        rows.append(row_texels)
    return rows


def fence_texels(side):
    """Slats with a rail at the foot of each repetition."""
    return [[255 if column < side * 5 // 8 or row >= side * 7 // 8 else 0 for column in range(side)]
            for row in range(side)]


def object_materials(names_and_materials):
    """The materials of the room under the names of the objects that have them."""
    library = dict(part.split("\n", 1) for part in ROOM_MATERIALS.split("newmtl ")[1:])
    lines = [ROOM_MATERIALS.split("\n", 1)[0]]
    for name, material in names_and_materials:
        lines += [f"newmtl {name}", library[material].strip(), ""]
    return "\n".join(lines)


def rgb_png(rows):
    data = b"".join(b"\0" + b"".join(bytes(texel) for texel in row) for row in rows)
    return png_file(len(rows[0]), len(rows), 2, data)


def png(rows, with_color):
    """An 8-bit image: the texels as grey, or as the alpha of a white one."""
    data = b"".join(b"\0" + b"".join(bytes([255, t]) if with_color else bytes([t]) for t in row) for row in rows)
    return png_file(len(rows[0]), len(rows), 4 if with_color else 0, data)


def png_file(width, height, color_type, data):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, color_type, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b"")


def main():
    folder = pathlib.Path(__file__).parent
    (folder / "cornell_box.mtl").write_text(ROOM_MATERIALS)
    (folder / "cornell_box.obj").write_text("\n".join(room_lines("cornell_box.mtl") + block_lines()) + "\n")
    (folder / "cornell_spheres.mtl").write_text(ROOM_MATERIALS + SPHERE_MATERIALS)
    (folder / "cornell_spheres.obj").write_text("\n".join(room_lines("cornell_spheres.mtl") + sphere_lines()) + "\n")
    (folder / "foliage.mtl").write_text(FOLIAGE_MATERIALS)
    (folder / "foliage.obj").write_text("\n".join(foliage_lines()) + "\n")
    (folder / "leaf.png").write_bytes(png(leaf_texels(64), with_color=True))
    (folder / "fence.png").write_bytes(png(fence_texels(16), with_color=False))

    room = [(name, material) for name, material, _ in ROOM]
    (folder / "cornell_room.mtl").write_text(object_materials(room))
    (folder / "cornell_room.obj").write_text("\n".join(room_lines("cornell_room.mtl", True)) + "\n")
    blocks = [(name, "white") for name, _, _ in BLOCKS]
    (folder / "cornell_blocks.mtl").write_text(object_materials(blocks))
    block_text = SOURCE + ["mtllib cornell_blocks.mtl"] + block_lines(True)
    (folder / "cornell_blocks.obj").write_text("\n".join(block_text) + "\n")
    (folder / "knot.mtl").write_text(knot.MATERIAL)
    (folder / "knot.obj").write_text("\n".join(knot.lines()) + "\n")
    (folder / "house.mtl").write_text(house.MATERIALS)
    (folder / "house.obj").write_text("\n".join(house.lines()) + "\n")
    (folder / "tiles.png").write_bytes(rgb_png(house.tile_texels(64)))
    (folder / "sky.exr").write_bytes(sky.exr())
    (folder / "in_one_weekend.json").write_text(weekend.text())


if __name__ == "__main__":
    main()
