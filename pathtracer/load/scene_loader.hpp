#pragma once

#include <filesystem>

#include "pathtracer/load/access/load_options.hpp"
#include "pathtracer/load/obj/obj_loader.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// Reads a scene in any format that Tandem knows, told by the file's extension in either case: .obj (load_obj), .json
/// (load_description), .gltf and .glb (load_gltf).
/// A scene far from 0 gets an origin of its own (scene/local_origin.hpp), and is read twice for it.
/// Throws Error, naming the file, for an extension that is none of them and for what the format's loader refuses.
/// @param options for all files that are read
Scene load_scene(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace tandem::pathtracer
