"""A trefoil knot: a smooth closed tube, our own."""
import math

from generators.mesh import cross, number, unit

AROUND = 96
ACROSS = 16
THICKNESS = 0.2


def curve(t):
    return (0.28 * (math.sin(t) + 2 * math.sin(2 * t)), 0.28 * (math.cos(t) - 2 * math.cos(2 * t)), -0.3 * math.sin(3 * t))


def lines():
    text = ["# A trefoil knot. Written by scenes/make_scenes.py.", "mtllib knot.mtl", "usemtl knot"]
    for i in range(AROUND):
        t = 2 * math.pi * i / AROUND
        centre = curve(t)
        tangent = unit([b - a for a, b in zip(curve(t - 1e-4), curve(t + 1e-4))])
        # The radial direction is never along the curve, so the frame closes by itself.
        side = unit(cross(tangent, (0, 0, 1)))
        above = cross(side, tangent)
        for j in range(ACROSS):
            angle = 2 * math.pi * j / ACROSS
            normal = [math.cos(angle) * s + math.sin(angle) * a for s, a in zip(side, above)]
            text.append("v " + " ".join(number(c + THICKNESS * n, 4) for c, n in zip(centre, normal)))
            text.append("vn " + " ".join(number(n, 4) for n in normal))
    for i in range(AROUND):
        for j in range(ACROSS):
            corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
            indices = [(a % AROUND) * ACROSS + b % ACROSS + 1 for a, b in corners]
            text.append("f " + " ".join(f"{k}//{k}" for k in indices))
    return text


MATERIAL = "# Written by scenes/make_scenes.py\nnewmtl knot\nKd 0.2 0.35 0.75\n"
