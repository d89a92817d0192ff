#!/usr/bin/env python3
"""Writes still_life.glb beside this script: our own, in decimetres. A glazed vase with a gold band and twigs of leaves
in it, a brass plate, a glass bead and a checkered cloth, under a lamp and a spot light.

It uses what glTF offers to a path tracer: base colour, metallic-roughness and normal textures, a cut-out, transmission,
a texture transform, an emissive lamp, a spot light, a camera, and meshes shown by several nodes, one of them mirrored.
The same script gives the same bytes.
"""
import json
import math
import pathlib
import random
import struct
import zlib

FLOAT, SHORT = 5126, 5123


def png(width, height, channels, pixel):
    """pixel(x, y) gives `channels` numbers in [0, 1], with x and y in [0, 1], y downwards."""
    rows = bytearray()
    for row in range(height):
        line = bytearray()
        for column in range(width):
            values = pixel((column + 0.5) / width, (row + 0.5) / height)
            line += bytes(round(255 * min(max(value, 0), 1)) for value in values)
        # Differences to the pixel on the left compress better.
        rows.append(1)
        rows += bytes((line[i] - (line[i - channels] if i >= channels else 0)) & 255 for i in range(len(line)))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 3: 2, 4: 6}[channels], 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 9)) +
            chunk(b"IEND", b""))


def normal_map(width, height, strength, surface):
    """Tangent-space normals of a height field that repeats; its v axis points upwards."""
    def pixel(x, y):
        dx = (surface(x + 0.5 / width, y) - surface(x - 0.5 / width, y)) * width * strength
        dy = (surface(x, y + 0.5 / height) - surface(x, y - 0.5 / height)) * height * strength
        normal = (-dx, dy, 1)
        length = math.sqrt(sum(n * n for n in normal))
        return [0.5 + 0.5 * n / length for n in normal]
    return png(width, height, 3, pixel)


class Noise:
    """Value noise that repeats with period 1, smooth."""

    def __init__(self, seed, cells):
        generator = random.Random(seed)
        self.cells = cells
        self.values = [[generator.random() for _ in range(cells)] for _ in range(cells)]

    def __call__(self, x, y):
        x, y = x * self.cells, y * self.cells
        column, row = math.floor(x), math.floor(y)
        u, v = x - column, y - row
        u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
        at = lambda i, j: self.values[(row + j) % self.cells][(column + i) % self.cells]
        return (at(0, 0) * (1 - u) + at(1, 0) * u) * (1 - v) + (at(0, 1) * (1 - u) + at(1, 1) * u) * v


# Meshes: lists of positions, normals, texture coordinates (v downwards), and triangles.

def curve(points, steps):
    """Points of a Catmull-Rom spline through `points`."""
    result = []
    for i in range(len(points) - 1):
        before, start, end, after = points[max(i - 1, 0)], points[i], points[i + 1], points[min(i + 2, len(points) - 1)]
        for step in range(steps):
            t = step / steps
            result.append(tuple(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t +
                                       (3 * b - a - 3 * c + d) * t * t * t)
                                for a, b, c, d in zip(before, start, end, after)))
    return result + [points[-1]]


def lathe(profile, segments):
    """Turns a profile of (radius, height), from its lower outer end on, about the y axis. Normals point outwards."""
    positions, normals, coordinates, triangles = [], [], [], []
    length = [0.0]
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        length.append(length[-1] + math.hypot(r1 - r0, y1 - y0))
    for i, (radius, height) in enumerate(profile):
        before, after = profile[max(i - 1, 0)], profile[min(i + 1, len(profile) - 1)]
        dr, dy = after[0] - before[0], after[1] - before[1]
        scale = 1 / math.hypot(dr, dy)
        for segment in range(segments + 1):
            angle = 2 * math.pi * segment / segments
            s, c = math.sin(angle), math.cos(angle)
            positions.append((max(radius, 0) * s, height, max(radius, 0) * c))
            normals.append((dy * scale * s, -dr * scale, dy * scale * c))
            coordinates.append((segment / segments, 1 - length[i] / length[-1]))
    row = segments + 1
    for i in range(len(profile) - 1):
        for segment in range(segments):
            a, b = i * row + segment, (i + 1) * row + segment
            if profile[i][0] > 0:
                triangles.append((a, a + 1, b + 1))
            if profile[i + 1][0] > 0:
                triangles.append((a, b + 1, b))
    return positions, normals, coordinates, triangles


def vase():
    return lathe(curve([(0, 0), (0.52, 0), (0.62, 0.12), (0.9, 0.7), (0.86, 1.2), (0.5, 1.75), (0.36, 2.1), (0.42, 2.4),
                        (0.56, 2.58), (0.52, 2.6), (0.38, 2.38), (0.31, 2.1), (0.44, 1.75), (0.78, 1.2), (0.8, 0.7),
                        (0.5, 0.15), (0, 0.12)], 4), 64)


def plate():
    return lathe(curve([(0, 0), (0.7, 0), (0.78, 0.04), (1.25, 0.2), (1.28, 0.23), (1.24, 0.24), (0.76, 0.09),
                        (0.68, 0.06), (0, 0.06)], 4), 64)


def ball(radius):
    steps = 32
    return lathe([(radius * math.sin(math.pi * i / steps) if 0 < i < steps else 0.0,
                   -radius * math.cos(math.pi * i / steps)) for i in range(steps + 1)], 48)


def sheet(half_width, half_depth):
    """Level, facing upwards."""
    corners = [(-1, 1), (1, 1), (1, -1), (-1, -1)]
    return ([(x * half_width, 0, z * half_depth) for x, z in corners], [(0, 1, 0)] * 4,
            [((x + 1) / 2, (z + 1) / 2) for x, z in corners], [(0, 1, 2), (0, 2, 3)])


def leaf_card():
    """A strip of quads from the origin along +x that droops, facing upwards."""
    positions, normals, coordinates, triangles = [], [], [], []
    for i in range(7):
        t = i / 6
        slope = -1.1 * t
        length = math.hypot(1, slope)
        for side in (1, -1):
            positions.append((t, -0.55 * t * t, 0.28 * side))
            normals.append((-slope / length, 1 / length, 0))
            coordinates.append((t, 0.5 + 0.5 * side))
    for i in range(6):
        a = 2 * i
        triangles += [(a, a + 2, a + 3), (a, a + 3, a + 1)]
    return positions, normals, coordinates, triangles


# Textures.

BAND = (0.71, 0.75)  # of the vase's height along its profile, downwards


def on_band(y):
    return BAND[0] < y < BAND[1]


def glaze(x, y):
    """Blue waves on white, above and below a gold band."""
    if on_band(y):
        return (0.95, 0.72, 0.3)
    mottling = 0.06 * GLAZE_NOISE(x, y)
    wave = math.sin(2 * math.pi * (16 * x + 1.5 * math.sin(2 * math.pi * 6 * y)))
    painted = 0.56 < y < 0.95 and wave > 0.35 or 0.952 < y < 0.962 or 0.548 < y < 0.556
    return (0.1 + mottling, 0.22 + mottling, 0.55) if painted else (0.9 - mottling, 0.9 - mottling, 0.86 - mottling)


def glaze_roughness(x, y):
    return (0, 0.25, 1) if on_band(y) else (0, 0.12 + 0.25 * GLAZE_NOISE(x, y), 0)


def glaze_relief(x, y):
    return 1.0 if on_band(y) else 0.35 * GLAZE_NOISE(x, y)


def hammered(x, y):
    return HAMMER_NOISE(x, y) + 0.5 * GLAZE_NOISE(x, y)


def cloth(x, y):
    red, blue = x < 0.5, y < 0.5
    return (0.62, 0.07, 0.06) if red and blue else (0.8, 0.35, 0.32) if red or blue else (0.93, 0.9, 0.84)


def weave(x, y):
    u, v = 16 * x, 16 * y
    over = (math.floor(u) + math.floor(v)) % 2 == 0
    return abs(math.sin(math.pi * (v if over else u)))


def leaf(x, y):
    """Green with veins, transparent outside of an almond shape. Its edge lies within the picture."""
    side = abs(2 * y - 1)
    width = 0.9 * math.sin(math.pi * min(max((x - 0.02) / 0.96, 0), 1)) ** 0.8
    vein = side < 0.05 or abs((x * 9 - side * 2.5) % 1 - 0.5) < 0.06
    green = (0.35, 0.5, 0.16) if vein else (0.12 + 0.1 * x, 0.34 + 0.12 * x, 0.07)
    return green + (0.5 + (width - side) * 8,)


GLAZE_NOISE, HAMMER_NOISE = Noise(1, 24), Noise(2, 12)


class Document:
    def __init__(self):
        self.data = bytearray()
        self.json = {"asset": {"version": "2.0", "generator": "scenes/make_gltf.py"}, "scene": 0,
                     "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_ior",
                                        "KHR_materials_transmission", "KHR_texture_transform"]}

    def add(self, array, item):
        self.json.setdefault(array, []).append(item)
        return len(self.json[array]) - 1

    def view(self, content):
        self.data += bytes(-len(self.data) % 4)
        self.data += content
        return self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.data) - len(content), "byteLength": len(content)})

    def accessor(self, rows, kind, component, code):
        content = b"".join(struct.pack("<%d%s" % (len(row), code), *row) for row in rows)
        item = {"bufferView": self.view(content), "componentType": component, "count": len(rows), "type": kind}
        if kind == "VEC3":
            # The bounds must be those of the numbers as they are stored.
            stored = [struct.unpack("<3f", struct.pack("<3f", *row)) for row in rows]
            item.update(min=[min(column) for column in zip(*stored)], max=[max(column) for column in zip(*stored)])
        return self.add("accessors", item)

    def mesh(self, name, geometry, material):
        positions, normals, coordinates, triangles = geometry
        indices = [(index,) for triangle in triangles for index in triangle]
        return self.add("meshes", {"name": name, "primitives": [{
            "attributes": {"POSITION": self.accessor(positions, "VEC3", FLOAT, "f"),
                           "NORMAL": self.accessor(normals, "VEC3", FLOAT, "f"),
                           "TEXCOORD_0": self.accessor(coordinates, "VEC2", FLOAT, "f")},
            "indices": self.accessor(indices, "SCALAR", SHORT, "H"), "material": material}]})

    def texture(self, name, content):
        image = self.add("images", {"name": name, "mimeType": "image/png", "bufferView": self.view(content)})
        return self.add("textures", {"source": image, "sampler": 0})

    def node(self, **node):
        return self.add("nodes", node)

    def write(self, path):
        self.json["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        data = bytes(self.data) + bytes(-len(self.data) % 4)
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) +
                         struct.pack("<I4s", len(text), b"JSON") + text +
                         struct.pack("<I4s", len(data), b"BIN\0") + data)


def turn(axis, degrees):
    half = math.radians(degrees) / 2
    return [math.sin(half) * component for component in axis] + [math.cos(half)]


def materials(document):
    document.add("samplers", {"wrapS": 10497, "wrapT": 10497, "magFilter": 9729, "minFilter": 9987})
    fine = {"extensions": {"KHR_texture_transform": {"scale": [10, 10]}}}
    texture = document.texture
    relief = texture("relief", normal_map(256, 256, 0.04, glaze_relief))
    dents = texture("dents", normal_map(128, 128, 0.015, hammered))
    threads = texture("threads", normal_map(128, 128, 0.02, weave))
    return {
        "glaze": document.add("materials", {"name": "glaze", "normalTexture": {"index": relief, "scale": 0.5},
            "pbrMetallicRoughness": {
                "baseColorTexture": {"index": texture("glaze", png(256, 256, 3, glaze))},
                "metallicRoughnessTexture": {"index": texture("glaze_roughness", png(256, 256, 3, glaze_roughness))}}}),
        "brass": document.add("materials", {"name": "brass", "normalTexture": {"index": dents},
            "pbrMetallicRoughness": {"baseColorFactor": [0.89, 0.66, 0.32, 1], "roughnessFactor": 0.3}}),
        "glass": document.add("materials", {"name": "glass",
            "pbrMetallicRoughness": {"baseColorFactor": [0.85, 0.95, 1, 1], "metallicFactor": 0, "roughnessFactor": 0.05},
            "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.45}}}),
        "cloth": document.add("materials", {"name": "cloth", "normalTexture": {"index": threads, **fine},
            "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.9, "baseColorTexture": {
                "index": texture("cloth", png(64, 64, 3, cloth)), **fine}}}),
        "leaf": document.add("materials", {"name": "leaf", "alphaMode": "MASK", "alphaCutoff": 0.5, "doubleSided": True,
            "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.45,
                "baseColorTexture": {"index": texture("leaf", png(128, 64, 4, leaf))}}}),
        "wall": document.add("materials", {"name": "wall",
            "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.52, 0.5, 1], "metallicFactor": 0, "roughnessFactor": 1}}),
        "lamp": document.add("materials", {"name": "lamp", "emissiveFactor": [1, 0.93, 0.82],
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 14}},
            "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}}),
    }


def twigs(document, mesh):
    """Leaves all around the mouth of the vase, every third one mirrored."""
    nodes = []
    for i in range(11):
        scale = 1.4 + 0.12 * (i * 5 % 7)
        lean = document.node(mesh=mesh, rotation=turn((0, 0, 1), 42 + 5 * (i * 3 % 8)),
                             scale=[scale, scale, -scale if i % 3 == 0 else scale])
        nodes.append(document.node(translation=[0, 2.25 + 0.05 * (i % 5), 0], rotation=turn((0, 1, 0), 137.5 * i),
                                   children=[lean]))
    return nodes


def main():
    document = Document()
    material = materials(document)
    cloth_mesh = document.mesh("cloth", sheet(8, 8), material["cloth"])
    wall_mesh = document.mesh("wall", sheet(12, 6), material["wall"])
    lamp_mesh = document.mesh("lamp", sheet(1.6, 1.2), material["lamp"])
    bead = document.mesh("bead", ball(0.45), material["glass"])
    leaves = twigs(document, document.mesh("leaf", leaf_card(), material["leaf"]))
    document.json["extensions"] = {"KHR_lights_punctual": {"lights": [
        {"name": "spot", "type": "spot", "color": [1, 0.85, 0.65], "intensity": 160,
         "spot": {"innerConeAngle": 0.18, "outerConeAngle": 0.32}}]}}
    document.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1, "aspectRatio": 1}})
    nodes = [
        document.node(name="cloth", mesh=cloth_mesh, rotation=turn((0, 1, 0), 20)),
        document.node(name="wall", mesh=wall_mesh, translation=[0, 3, -6], rotation=turn((1, 0, 0), 90)),
        document.node(name="lamp", mesh=lamp_mesh, translation=[3.2, 6.5, 2.5], rotation=turn((1, 0, 0), 180)),
        document.node(name="vase", translation=[-0.5, 0, 0], children=leaves +
                      [document.node(mesh=document.mesh("vase", vase(), material["glaze"]))]),
        document.node(name="plate", mesh=document.mesh("plate", plate(), material["brass"]), translation=[1.35, 0, 0.9]),
        document.node(name="bead", mesh=bead, translation=[-1.35, 0.45, 1.35]),
        document.node(name="small bead", mesh=bead, translation=[1.5, 0.33, 0.95], scale=[0.6, 0.6, 0.6]),
        document.node(name="spot", translation=[-5, 6, 5], rotation=turn((0, 1, 0), -42),
                      children=[document.node(rotation=turn((1, 0, 0), -36),
                                              extensions={"KHR_lights_punctual": {"light": 0}})]),
        document.node(name="camera", translation=[0.15, 3.6, 8.6], rotation=turn((1, 0, 0), -14), camera=0),
    ]
    document.add("scenes", {"nodes": nodes})
    document.write(pathlib.Path(__file__).parent / "still_life.glb")


if __name__ == "__main__":
    main()
