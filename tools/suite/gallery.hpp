#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pathtracer/image/image.hpp"
#include "tools/report/comparison_report.hpp"

/// The gallery: scenes that are rendered on two devices, with the verdict on each.
namespace tandem::tools {

struct GalleryScene {
  std::string name;  ///< of the file, without its extension; names its pictures too
  std::filesystem::path file;
  std::string title;
  std::uint32_t samples = 16;  ///< per pixel
};

/// Reads the list: {"scenes": [{"file", "title", "samples"}, ...]}, where the last may be absent. Throws
/// Error, naming the place.
std::vector<GalleryScene> read_gallery(const std::filesystem::path& path);

/// What scenes must keep whose own thresholds do not say otherwise.
compare::Thresholds gallery_thresholds();

/// A scene with what came of it; the report's images may be dropped.
struct GalleryResult {
  GalleryScene scene;
  compare::Comparison comparison;
};

/// The page for people: a table with the pictures, which lie in `pictures`, relative to the page.
std::string gallery_markdown(const std::vector<GalleryResult>& results, const std::string& pictures);

/// The same for programs: what `tandem diff` says of each scene.
nlohmann::ordered_json to_json(const std::vector<GalleryResult>& results);

/// The worst of all.
compare::Outcome outcome_of(const std::vector<GalleryResult>& results);

/// The picture with neither side longer than `largest`: each pixel the mean of a square of the original, whose rest at
/// the right and lower edge is left out.
pathtracer::Image reduced(const pathtracer::Image& image, std::uint32_t largest);

}  // namespace tandem::tools
