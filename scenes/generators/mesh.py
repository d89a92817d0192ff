"""Wavefront text: numbers and faces."""
import math


def unit(vector):
    length = math.sqrt(sum(x * x for x in vector))
    return tuple(x / length for x in vector)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def number(value, decimals):
    text = f"{value:.{decimals}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def face_lines(corners, coordinates=None):
    """A polygon with vertices of its own, counter-clockwise from outside, and texture coordinates where given."""
    lines = ["v " + " ".join(number(x, 4) for x in corner) for corner in corners]
    count = len(corners)
    if coordinates is None:
        return lines + ["f " + " ".join(str(i - count) for i in range(count))]
    lines += ["vt " + " ".join(number(x, 4) for x in pair) for pair in coordinates]
    return lines + ["f " + " ".join(f"{i - count}/{i - count}" for i in range(count))]


def box_lines(origin, u, v, w):
    """The parallelepiped origin + [0, 1] u + [0, 1] v + [0, 1] w, whose u x v points along w."""
    def at(i, j, k):
        return tuple(o + i * a + j * b + k * c for o, a, b, c in zip(origin, u, v, w))

    faces = [((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)), ((1, 0, 0), (0, 0, 0), (0, 1, 0), (1, 1, 0)),
             ((1, 0, 1), (1, 0, 0), (1, 1, 0), (1, 1, 1)), ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)),
             ((0, 1, 1), (1, 1, 1), (1, 1, 0), (0, 1, 0)), ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1))]
    return [line for face in faces for line in face_lines([at(*corner) for corner in face])]
