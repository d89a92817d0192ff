"""An equirectangular sky, our own, as an OpenEXR file of half floats without compression."""
import math
import struct

WIDTH, HEIGHT = 128, 64
SUN = (math.radians(40), math.radians(35))  # to the right of the centre, above the horizon
SUN_RADIANCE = 160


def radiance(column, row):
    longitude = (column + 0.5) / WIDTH * 2 * math.pi - math.pi
    latitude = math.pi / 2 - (row + 0.5) / HEIGHT * math.pi
    if latitude < 0:
        return (0.16, 0.14, 0.12)
    height = math.sin(latitude)
    color = [0.85 - 0.65 * height ** 0.5, 0.9 - 0.5 * height ** 0.5, 1.0 - 0.25 * height ** 0.5]
    cosine = (math.sin(latitude) * math.sin(SUN[1]) +
              math.cos(latitude) * math.cos(SUN[1]) * math.cos(longitude - SUN[0]))
    angle = math.degrees(math.acos(min(1, max(-1, cosine))))
    if angle < 4:
        return (SUN_RADIANCE, 0.9 * SUN_RADIANCE, 0.7 * SUN_RADIANCE)
    glow = 1.5 * math.exp(-angle / 12)
    return tuple(c + glow * g for c, g in zip(color, (1, 0.85, 0.6)))


def attribute(name, kind, data):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def exr():
    # Header and scan lines as the OpenEXR file layout has them: https://openexr.com/en/latest/OpenEXRFileLayout.html
    half = 1
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", half, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, WIDTH - 1, HEIGHT - 1)
    header = struct.pack("<ii", 20000630, 2)
    header += attribute("channels", "chlist", channels) + attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window)
    header += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    line_size = WIDTH * 3 * 2
    first = len(header) + 8 * HEIGHT
    offsets = b"".join(struct.pack("<Q", first + row * (8 + line_size)) for row in range(HEIGHT))
    data = b""
    for row in range(HEIGHT):
        pixels = [radiance(column, row) for column in range(WIDTH)]
        planes = [struct.pack(f"<{WIDTH}e", *(pixel[channel] for pixel in pixels)) for channel in (2, 1, 0)]
        data += struct.pack("<ii", row, line_size) + b"".join(planes)
    return header + offsets + data
