"""A description of many spheres, some of them falling, in the manner of Shirley's "Ray Tracing in One Weekend"."""
import json
import random


def description():
    source = random.Random(11)
    materials = {"ground": {"model": "diffuse", "base_color": "tiles"}, "glass": {"model": "dielectric", "ior": 1.5},
                 "brown": {"model": "diffuse", "base_color": [0.4, 0.2, 0.1]},
                 "metal": {"model": "conductor", "reflectance": [0.7, 0.6, 0.5], "roughness": 0},
                 "marble": {"model": "diffuse", "base_color": "marble"}, "mist": {"model": "boundary", "medium": "mist"}}
    spheres = [{"centre": [0, 1, 0], "radius": 1, "material": "glass"},
               {"centre": [-4, 1, 0], "radius": 1, "material": "marble"},
               {"centre": [4, 1, 0], "radius": 1, "material": "metal"},
               {"centre": [1.2, 0.7, 2.2], "radius": 0.7, "material": "mist"}]
    for i in range(6):
        color = [round(source.random() * source.random(), 3) for _ in range(3)]
        materials[f"diffuse_{i}"] = {"model": "diffuse", "base_color": color}
        metal = [round(source.uniform(0.5, 1), 3) for _ in range(3)]
        materials[f"metal_{i}"] = {"model": "conductor", "reflectance": metal, "roughness": round(source.uniform(0.1, 0.6), 2)}
    for a in range(-7, 7):
        for b in range(-7, 6):
            x, z = round(a + 0.8 * source.random(), 3), round(b + 0.8 * source.random(), 3)
            if any((x - s["centre"][0]) ** 2 + (z - s["centre"][2]) ** 2 < (s["radius"] + 0.25) ** 2 for s in spheres[:4]):
                continue
            kind, choice = source.random(), source.randrange(6)
            sphere = {"centre": [x, 0.2, z], "radius": 0.2}
            if kind < 0.7:
                sphere["material"] = f"diffuse_{choice}"
                sphere["motion"] = [0, round(source.uniform(0, 0.5), 3), 0]
            else:
                sphere["material"] = f"metal_{choice}" if kind < 0.9 else "glass"
            spheres.append(sphere)
    return {"$schema": "../docs/schema/scene.schema.json",
            "title": "Spheres, some of which move, and a ball of mist, after Shirley, \"Ray Tracing in One Weekend\" (2020)",
            "spheres": spheres,
            "quads": [{"corner": [-40, 0, 40], "u": [80, 0, 0], "v": [0, 0, -80], "material": "ground"}],
            "materials": materials,
            "textures": {"tiles": {"type": "checker", "scale": 64, "color_a": [0.2, 0.3, 0.1], "color_b": 0.8},
                         "marble": {"type": "noise", "scale": 3, "color_a": 0.1, "color_b": 0.9}},
            "media": {"mist": {"absorption": [0.3, 0.1, 0.02], "scattering": 2.5}},
            "environment": {"radiance": [0.6, 0.75, 1]},
            "camera": {"position": [13, 2, 5], "target": [0, 0.4, 0], "fov": 22, "lens_radius": 0.05,
                       "focus_distance": 12}}


def text():
    """JSON with one entry of a list or object a line."""
    lines = []
    for key, value in description().items():
        if isinstance(value, list):
            lines.append(f'  "{key}": [\n    ' + ",\n    ".join(json.dumps(v) for v in value) + "\n  ]")
        elif isinstance(value, dict) and key != "camera":
            entries = (f'"{name}": {json.dumps(v)}' for name, v in value.items())
            lines.append(f'  "{key}": {{\n    ' + ",\n    ".join(entries) + "\n  }")
        else:
            lines.append(f'  "{key}": {json.dumps(value)}')
    return "{\n" + ",\n".join(lines) + "\n}\n"
