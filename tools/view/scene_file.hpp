#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "pathtracer/scene/scene.hpp"
#include "tools/view/view.hpp"

namespace tandem::view {

/// What a view is saved from.
struct SavedView {
  std::filesystem::path scene_file;
  const pathtracer::Scene& scene;  ///< as it was loaded, studio light included
  View view;
  std::uint32_t samples = 1;  ///< per pixel, that the picture has
};

/// A scene description (docs/guide/scenes.md) of what the window shows: the scene file, or a copy of its description,
/// with the camera, the settings and the lights without extent as they are in the view. Samplers that lay out all
/// samples of a picture in advance are described with all of them (RenderSettings::planned_samples).
/// @param folder where the description is to be stored: names of files are relative to it
/// Throws Error for what a description cannot say: changed lights where those of the scene come from a model, or in
/// the studio light, which only scenes without lights of their own have.
nlohmann::ordered_json scene_description(const SavedView& saved, const std::filesystem::path& folder);

}  // namespace tandem::view
