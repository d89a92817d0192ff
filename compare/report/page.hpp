#pragma once

#include <string>
#include <vector>

#include "compare/cause/classification.hpp"
#include "compare/image/flip/flip.hpp"
#include "compare/report/ranking.hpp"
#include "pathtracer/image/image.hpp"
#include "pathtracer/render/path_event.hpp"

/// A page of HTML about the difference of two devices, for people who open it in a browser.
namespace tandem::compare {

/// What became of a path on both devices.
struct RecordedPath {
  pathtracer::PathId path;
  /// JSON: an array of {"segment": number, "event": name, "fields": {name: {"a": value, "b": value, "ulp": number}}},
  /// side by side. "b" is absent where it has the bits of a; "only" is "a" or "b" in an event that only this device
  /// has. "name_a" and "name_b" may say what a value names.
  std::string events;
};

/// What a page shows. What it refers to must live while the page is made.
struct ReportPage {
  std::string title;    ///< of the window
  std::string numbers;  ///< JSON, as `tandem diff --json` has it: every number in the page's tables is one of these
  const pathtracer::Image& a;
  const pathtracer::Image& b;
  const FlipErrors* flip = nullptr;                ///< null: the page has no map of it
  const Classification* classification = nullptr;  ///< null: no class is shown
  const Ranking& ranking;                          ///< of the images
  std::vector<RecordedPath> paths = {};            ///< most important first
};

/// The whole page: it refers to no other file and to no address. UTF-8.
///
/// Images are in it to the last bit as far as usual_image_budget goes; of larger ones only the ranked pixels are, and
/// the page says so. Throws as check_pair.
std::string page(const ReportPage& contents);

}  // namespace tandem::compare
