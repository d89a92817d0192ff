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

/// Reads the list: {"scenes": [{"file", "title", "spp"}, ...]}, where the last may be absent and may be called
/// "samples". Throws Error, naming the place.
std::vector<GalleryScene> read_gallery(const std::filesystem::path& path);

/// What scenes must keep whose own thresholds do not say otherwise.
compare::Thresholds gallery_thresholds();

/// A scene with what came of it; the report's images may be dropped.
struct GalleryResult {
  GalleryScene scene;
  compare::Comparison comparison;
  pathtracer::Image picture = {};     ///< that of a, small
  pathtracer::Image difference = {};  ///< where b differs from it, small
};

/// All scenes that were rendered, and of how many.
struct Gallery {
  std::vector<GalleryResult> results;
  std::size_t listed = 0;  ///< more than there are results if the run ended early
  std::string date;
  std::string command;  ///< the command line
};

/// Where the pictures of a scene lie, relative to the pages, with slashes. Of every file name.
std::filesystem::path picture_path(const GalleryScene& scene);
std::filesystem::path difference_path(const GalleryScene& scene);

/// The page as Markdown, which code hosts show: a table with the pictures.
std::string gallery_markdown(const Gallery& gallery);

/// The page for a browser.
std::string gallery_html(const Gallery& gallery);

/// The same for programs: what `tandem diff` says of each scene.
nlohmann::ordered_json to_json(const Gallery& gallery);

/// The worst of all.
compare::Outcome outcome_of(const std::vector<GalleryResult>& results);

/// The picture with neither side longer than `largest`: each pixel the mean of a square of the original, whose rest at
/// the right and lower edge is left out.
pathtracer::Image reduced(const pathtracer::Image& image, std::uint32_t largest);

}  // namespace tandem::tools
