"""Renders an OBJ scene with Blender's Cycles and compares the picture with Tandem's, region by region.

Run by scripts/compare-cycles: blender --background --python compare_cycles.py -- SCENE.obj FOLDER RUNS REGIONS LAMPS
FOLDER holds Tandem's pictures tandem_0.exr, tandem_1.exr, ... of different seeds, all of the same size, samples and
depth, and gets those of Cycles. Only what the shipped Cornell boxes use is translated: diffuse, mirror and smooth glass
materials, emission, vertex normals. LAMPS is on when Cycles may send rays to lamps, else off.
"""

import json
import math
import re
import subprocess
import sys

import bpy
import mathutils


def read_mtl(path):
    """Name to a dictionary of numbers: Kd, Ks, Ke, Ni, illum."""
    materials = {}
    for line in open(path):
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        if words[0] == "newmtl":
            current = materials[words[1]] = {"Kd": (0.5, 0.5, 0.5), "Ke": (0, 0, 0), "Ks": (0, 0, 0), "illum": 1}
        elif words[0] in ("Kd", "Ks", "Ke"):
            current[words[0]] = tuple(float(word) for word in words[1:4])
        elif words[0] == "Ni":
            current["Ni"] = float(words[1])
        elif words[0] == "illum":
            current["illum"] = int(words[1])
    return materials


def absolute(index, values):
    """From 0, of an index from 1 or from the end of what was read so far."""
    return index - 1 if index > 0 else len(values) + index


def read_obj(path):
    """Positions, normals, and faces as (material, [(position, normal or None), ...])."""
    positions, normals, faces, libraries, material = [], [], [], [], None
    for line in open(path):
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            positions.append(tuple(float(word) for word in words[1:4]))
        elif words[0] == "vn":
            normals.append(tuple(float(word) for word in words[1:4]))
        elif words[0] == "mtllib":
            libraries.append(words[1])
        elif words[0] == "usemtl":
            material = words[1]
        elif words[0] == "f":
            corners = []
            for word in words[1:]:
                parts = word.split("/")
                normal = absolute(int(parts[2]), normals) if len(parts) == 3 else None
                corners.append((absolute(int(parts[0]), positions), normal))
            faces.append((material, corners))
    return positions, normals, faces, libraries


def make_material(name, source, samples_lamps):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.cycles.sample_as_light = samples_lamps
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    if source["illum"] in (3, 5, 8):
        surface = nodes.new("ShaderNodeBsdfGlossy")
        surface.inputs["Color"].default_value = (*source["Ks"], 1)
        surface.inputs["Roughness"].default_value = 0
    elif source["illum"] in (4, 6, 7, 9):
        surface = nodes.new("ShaderNodeBsdfGlass")
        surface.inputs["Color"].default_value = (1, 1, 1, 1)
        surface.inputs["Roughness"].default_value = 0
        surface.inputs["IOR"].default_value = source["Ni"]
    else:
        surface = nodes.new("ShaderNodeBsdfDiffuse")
        surface.inputs["Color"].default_value = (*source["Kd"], 1)
        surface.inputs["Roughness"].default_value = 0
    if any(source["Ke"]):
        emission = nodes.new("ShaderNodeEmission")
        emission.inputs["Color"].default_value = (*source["Ke"], 1)
        both = nodes.new("ShaderNodeAddShader")
        links.new(surface.outputs[0], both.inputs[0])
        links.new(emission.outputs[0], both.inputs[1])
        surface = both
    links.new(surface.outputs[0], output.inputs["Surface"])
    return material


def build_scene(path, samples_lamps):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    positions, normals, faces, libraries = read_obj(path)
    folder = path.rsplit("/", 1)[0] if "/" in path else "."
    sources = {}
    for library in libraries:
        sources.update(read_mtl(f"{folder}/{library}"))
    for name, source in sources.items():
        own = [corners for material, corners in faces if material == name]
        if not own:
            continue
        mesh = bpy.data.meshes.new(name)
        used = sorted({position for corners in own for position, _ in corners})
        index_of = {position: index for index, position in enumerate(used)}
        mesh.from_pydata([positions[i] for i in used], [], [[index_of[p] for p, _ in corners] for corners in own])
        if all(normal is not None for corners in own for _, normal in corners):
            for polygon in mesh.polygons:
                polygon.use_smooth = True
            mesh.use_auto_smooth = True
            mesh.normals_split_custom_set([normals[normal] for corners in own for _, normal in corners])
        mesh.materials.append(make_material(name, source, samples_lamps))
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def place_camera(description):
    """The camera as Tandem's pictures describe it."""
    numbers = [float(word) for word in description.split() if not word.isalpha()]
    position, target, up = (mathutils.Vector(numbers[i : i + 3]) for i in (0, 3, 6))
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = math.radians(numbers[9])
    camera.clip_start, camera.clip_end = 1e-3, 1e7
    thing = bpy.data.objects.new("camera", camera)
    backward = (position - target).normalized()
    right = up.cross(backward).normalized()
    axes = mathutils.Matrix((right, backward.cross(right), backward)).transposed()
    thing.matrix_world = mathutils.Matrix.Translation(position) @ axes.to_4x4()
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.scene.camera = thing


def render(path, metadata, seed):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = (int(side) for side in metadata["size"].split("x"))
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = path
    scene.render.use_compositing = False
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = int(metadata["samples"])
    cycles.seed = seed
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1.0
    cycles.light_sampling_threshold = 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    # Segments from the camera on: 2 is direct light, which Cycles calls no bounces.
    bounces = int(metadata["depth"]) - 2
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = bounces
    cycles.min_light_bounces = cycles.min_transparent_bounces = 0
    bpy.ops.render.render(write_still=True)


def metadata_of(path):
    text = subprocess.run(["oiiotool", "--info", "-v", path], capture_output=True, text=True, check=True).stdout
    return dict(re.findall(r'tandem:(\w+): "(.*)"', text))


def load(path):
    """Width, height and the pixels' r, g, b, a, row by row from the bottom."""
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    return image.size[0], image.size[1], list(image.pixels)


class Regions:
    """Means of square regions of a picture over all runs, and the variances of these means."""

    def __init__(self, paths, count):
        pictures = [load(path) for path in paths]
        width, height, _ = pictures[0]
        runs = len(pictures)
        self.mean = [[0.0] * 3 for _ in range(count * count)]
        self.variance = [[0.0] * 3 for _ in range(count * count)]
        pixels = [0] * (count * count)
        for y in range(height):
            for x in range(width):
                region = (y * count // height) * count + x * count // width
                pixels[region] += 1
                for channel in range(3):
                    values = [picture[2][4 * (y * width + x) + channel] for picture in pictures]
                    mean = sum(values) / runs
                    self.mean[region][channel] += mean
                    self.variance[region][channel] += sum((v - mean) ** 2 for v in values) / (runs - 1) / runs
        for region in range(count * count):
            for channel in range(3):
                self.mean[region][channel] /= pixels[region]
                self.variance[region][channel] /= pixels[region] ** 2


def main():
    scene_path, folder, runs, regions, lamps = sys.argv[sys.argv.index("--") + 1 :]
    runs, regions = int(runs), int(regions)
    metadata = metadata_of(f"{folder}/tandem_0.exr")
    build_scene(scene_path, lamps == "on")
    place_camera(metadata["camera"])
    for run in range(runs):
        render(f"{folder}/cycles_{run}.exr", metadata, run + 1)
    ours = Regions([f"{folder}/tandem_{run}.exr" for run in range(runs)], regions)
    theirs = Regions([f"{folder}/cycles_{run}.exr" for run in range(runs)], regions)
    scores, ratios = [], []
    for region in range(regions * regions):
        for channel in range(3):
            a, b = ours.mean[region][channel], theirs.mean[region][channel]
            deviation = math.sqrt(ours.variance[region][channel] + theirs.variance[region][channel])
            if deviation > 0:
                scores.append(abs(a - b) / deviation)
            if b > 0:
                ratios.append(a / b - 1)
    # The bound that the largest of so many independent standard normal scores exceeds once in a hundred comparisons.
    tail = 1 - 0.99 ** (1 / len(scores))
    low, high = 0.0, 10.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if math.erfc(middle / math.sqrt(2)) > tail else (low, middle)
    mean_ours = [sum(mean[channel] for mean in ours.mean) / regions**2 for channel in range(3)]
    mean_theirs = [sum(mean[channel] for mean in theirs.mean) / regions**2 for channel in range(3)]
    result = {
        "scene": scene_path,
        "size": metadata["size"],
        "samples": int(metadata["samples"]) * runs,
        "depth": int(metadata["depth"]),
        "cycles_samples_lamps": lamps == "on",
        "mean_tandem": mean_ours,
        "mean_cycles": mean_theirs,
        "relative_difference_of_means": [a / b - 1 for a, b in zip(mean_ours, mean_theirs)],
        "regions": regions * regions,
        "largest_relative_difference_of_a_region": max(abs(ratio) for ratio in ratios),
        "root_mean_square_score": math.sqrt(sum(score**2 for score in scores) / len(scores)),
        "largest_score": max(scores),
        "bound_of_largest_score": high,
    }
    with open(f"{folder}/result.json", "w") as file:
        json.dump(result, file, indent=2)


main()
