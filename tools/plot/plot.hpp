#pragma once

#include <string>
#include <vector>

/// Plots for pages that open from disk.
namespace tandem::tools {

struct PlotPoint {
  double x = 0;
  double y = 0;
  /// Of an error bar; the same as y, or NaN: none.
  double least = y, most = y;
};

struct PlotSeries {
  std::string label;
  std::vector<PlotPoint> points;  ///< in the order of the line; those that are not finite leave a gap
  bool has_line = true;
  bool has_marks = true;
  bool is_dashed = false;  ///< for what is fitted or published, beside what is measured
};

struct PlotAxis {
  std::string label;            ///< with its unit
  bool is_logarithmic = false;  ///< values of 0 and less are left out
  bool includes_zero = false;   ///< of a linear one
  /// In place of numbers: point x = i stands at the i-th name. Empty: numbers.
  std::vector<std::string> names = {};
};

struct Plot {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotSeries> series;
};

/// An <svg> element, 640 units wide, with its own style for light and dark pages. Colours are those of Okabe and Ito,
/// which colour-blind people tell apart; lines differ in their marks as well. A plot without a point says so.
std::string svg(const Plot& plot);

}  // namespace tandem::tools
