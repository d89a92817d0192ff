#include "tools/plot/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "tools/output/xml_text.hpp"
#include "tools/plot/ticks.hpp"

namespace tandem::tools {
namespace {

constexpr double width = 640, height = 360;
constexpr double left = 78, right = 18, top = 34, bottom = 52, legend_line = 18;

constexpr std::array<const char*, 7> colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                "#e69f00", "#56b4e9", "#8c6d31"};

/// One axis, from values to units of the picture.
class Scale {
 public:
  Scale(const PlotAxis& axis, double from, double to) : axis_(axis), from_(from), to_(to) {}

  bool shows(double value) const { return std::isfinite(value) && (!axis_.is_logarithmic || value > 0); }
  void include(double value) {
    if (!shows(value)) return;
    least_ = std::min(least_.value_or(value), value);
    most_ = std::max(most_.value_or(value), value);
  }
  bool is_empty() const { return !least_; }
  void finish() {
    if (!axis_.names.empty()) {
      ticks_ = {.least = -0.5, .most = static_cast<double>(axis_.names.size()) - 0.5, .values = {}};
      for (std::size_t i = 0; i < axis_.names.size(); ++i) ticks_.values.push_back(static_cast<double>(i));
    } else if (axis_.is_logarithmic) {
      ticks_ = logarithmic_ticks(*least_, *most_);
    } else {
      if (axis_.includes_zero) include(0);
      ticks_ = linear_ticks(*least_, *most_);
    }
  }
  double at(double value) const {
    const auto place = [&](double each) { return axis_.is_logarithmic ? std::log10(each) : each; };
    const double fraction = (place(value) - place(ticks_.least)) / (place(ticks_.most) - place(ticks_.least));
    return from_ + (to_ - from_) * fraction;
  }
  const std::vector<double>& ticks() const { return ticks_.values; }
  std::string text(double value) const {
    return axis_.names.empty() ? tick_text(value) : axis_.names[static_cast<std::size_t>(value)];
  }

 private:
  const PlotAxis& axis_;
  double from_, to_;
  std::optional<double> least_, most_;
  Ticks ticks_;
};

template <typename... Values>
void put(std::string& text, fmt::format_string<Values...> format, Values&&... values) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
}

/// A mark of its own for each series: a disc, a square, a diamond, a triangle.
void put_mark(std::string& text, std::size_t series, double x, double y, const std::string& tip) {
  const char* colour = colours[series % colours.size()];
  const std::string title = tip.empty() ? "" : fmt::format("<title>{}</title>", xml_text(tip));
  switch (series % 4) {
    case 0:
      return put(text, "<circle cx='{:.1f}' cy='{:.1f}' r='3.5' fill='{}'>{}</circle>\n", x, y, colour, title);
    case 1:
      return put(text, "<rect x='{:.1f}' y='{:.1f}' width='6.4' height='6.4' fill='{}'>{}</rect>\n", x - 3.2, y - 3.2,
                 colour, title);
    case 2:
      return put(text, "<path d='M{:.1f} {:.1f}l4.4 4.4l-4.4 4.4l-4.4 -4.4z' fill='{}'>{}</path>\n", x, y - 4.4, colour,
                 title);
    default:
      return put(text, "<path d='M{:.1f} {:.1f}l4.4 7.6h-8.8z' fill='{}'>{}</path>\n", x, y - 4.6, colour, title);
  }
}

void put_axes(std::string& text, const Plot& plot, const Scale& x, const Scale& y) {
  for (const double value : y.ticks()) {
    put(text, "<line class='grid' x1='{:.1f}' x2='{:.1f}' y1='{:.1f}' y2='{:.1f}'/>\n", left, width - right,
        y.at(value), y.at(value));
    put(text, "<text x='{:.1f}' y='{:.1f}' text-anchor='end'>{}</text>\n", left - 8, y.at(value) + 4,
        xml_text(y.text(value)));
  }
  for (const double value : x.ticks()) {
    put(text, "<line class='grid' x1='{:.1f}' x2='{:.1f}' y1='{:.1f}' y2='{:.1f}'/>\n", x.at(value), x.at(value), top,
        height - bottom);
    put(text, "<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>\n", x.at(value), height - bottom + 16,
        xml_text(x.text(value)));
  }
  put(text, "<rect class='frame' x='{}' y='{}' width='{}' height='{}'/>\n", left, top, width - left - right,
      height - top - bottom);
  put(text, "<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>\n", (left + width - right) / 2,
      height - bottom + 38, xml_text(plot.x.label));
  put(text, "<text transform='translate(16 {:.1f}) rotate(-90)' text-anchor='middle'>{}</text>\n",
      (top + height - bottom) / 2, xml_text(plot.y.label));
}

void put_series(std::string& text, const Plot& plot, std::size_t index, const Scale& x, const Scale& y) {
  const PlotSeries& series = plot.series[index];
  const char* colour = colours[index % colours.size()];
  const auto is_shown = [&](const PlotPoint& point) { return x.shows(point.x) && y.shows(point.y); };
  if (series.has_line) {
    std::string path;
    bool is_open = false;
    for (const PlotPoint& point : series.points) {
      if (is_shown(point)) put(path, "{}{:.1f} {:.1f}", is_open ? 'L' : 'M', x.at(point.x), y.at(point.y));
      is_open = is_shown(point);
    }
    put(text, "<path class='line' d='{}' stroke='{}'{}/>\n", path, colour,
        series.is_dashed ? " stroke-dasharray='6 4'" : "");
  }
  for (const PlotPoint& point : series.points) {
    if (!is_shown(point)) continue;
    if (y.shows(point.least) && y.shows(point.most) && point.least < point.most)
      put(text, "<line x1='{0:.1f}' x2='{0:.1f}' y1='{1:.1f}' y2='{2:.1f}' stroke='{3}' stroke-width='1.4'/>\n",
          x.at(point.x), y.at(point.least), y.at(point.most), colour);
    if (series.has_marks)
      put_mark(text, index, x.at(point.x), y.at(point.y),
               fmt::format("{}: {}, {}", series.label, x.text(point.x), tick_text(point.y)));
  }
}

void put_legend(std::string& text, const Plot& plot) {
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const double y = height + legend_line * static_cast<double>(i) + 6;
    if (plot.series[i].has_line)
      put(text, "<path class='line' d='M{:.1f} {:.1f}h28' stroke='{}'{}/>\n", left, y, colours[i % colours.size()],
          plot.series[i].is_dashed ? " stroke-dasharray='6 4'" : "");
    if (plot.series[i].has_marks) put_mark(text, i, left + 14, y, "");
    put(text, "<text x='{:.1f}' y='{:.1f}'>{}</text>\n", left + 36, y + 4, xml_text(plot.series[i].label));
  }
}

}  // namespace

std::string svg(const Plot& plot) {
  Scale x(plot.x, left, width - right), y(plot.y, height - bottom, top);
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& point : series.points) {
      if (!x.shows(point.x) || !y.shows(point.y)) continue;
      x.include(point.x);
      for (const double value : {point.y, point.least, point.most}) y.include(value);
    }
  const double total = height + legend_line * static_cast<double>(plot.series.size()) + 6;
  std::string text = fmt::format(
      "<svg class='plot' xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0} {1}' width='{0}' role='img'>\n"
      "<style>.plot{{font:12px sans-serif;max-width:100%}}.plot text{{fill:currentColor}}"
      ".plot .grid{{stroke:currentColor;opacity:.15}}.plot .frame{{fill:none;stroke:currentColor;opacity:.5}}"
      ".plot .line{{fill:none;stroke-width:1.8}}</style>\n"
      "<text x='{2}' y='20' font-weight='bold'>{3}</text>\n",
      width, total, left, xml_text(plot.title));
  if (x.is_empty()) {
    put(text, "<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>there is nothing to show</text>\n</svg>\n", width / 2,
        height / 2);
    return text;
  }
  x.finish();
  y.finish();
  put_axes(text, plot, x, y);
  for (std::size_t i = 0; i < plot.series.size(); ++i) put_series(text, plot, i, x, y);
  put_legend(text, plot);
  return text + "</svg>\n";
}

}  // namespace tandem::tools
