#include "tools/report/metrics_report.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

namespace tandem::tools {
namespace {

pathtracer::Image gray(float value) {
  return {.width = 8, .height = 4, .pixels = std::vector<glm::vec3>(32, glm::vec3(value))};
}

bool has_line(const std::string& table, const std::string& line) {
  return ('\n' + table).find('\n' + line + '\n') != std::string::npos;
}

TEST_CASE("the table of metrics has the numbers of the JSON") {
  const pathtracer::Image a = gray(1.0F);
  pathtracer::Image b = a;
  b.pixels[0].x = std::nextafter(1.0F, 2.0F);
  b.pixels[1].y = 1.0F + 6 * 0x1p-23F;
  b.pixels[31].z = 1.5F;
  const compare::DetailedMetrics metrics = compare::measure_in_detail(a, b, compare::MetricSet::basic);
  const std::string text = table(metrics);
  CHECK(has_line(text, "ULP apart         0: 93  1: 1  5-16: 1  65537 and more: 1  (largest 4194304)"));
  CHECK(has_line(text, "relative error    50 %: 0  90 %: 0  99 %: 0.333  99.9 %: 0.333  (largest 0.333)"));
  CHECK(has_line(text, "worst region      row 4, column 4 (pixels 6,3 to 7,3)"));
  CHECK(text.find("FLIP") == std::string::npos);
  const nlohmann::ordered_json json = to_json(metrics);
  CHECK(json.at("ulp").at("values") == 96);
  CHECK(json.at("ulp").at("largest") == 1 << 22);
  CHECK(json.at("ulp").at("bins").at(0).at("values") == 93);
  CHECK(json.at("relative_error").at("max").get<double>() == doctest::Approx(1.0 / 3.0));
  CHECK(json.at("rel_mse").get<double>() == doctest::Approx(0.25 / 1.01 / 96));
  CHECK(json.at("worst_region") == 15);
  CHECK(json.at("regions").size() == 16);
  CHECK_FALSE(json.contains("flip"));
}

TEST_CASE("all metrics have FLIP and a line for each region") {
  const compare::DetailedMetrics metrics = compare::measure_in_detail(gray(0.0F), gray(1.0F), compare::MetricSet::all);
  const std::string text = table(metrics);
  const std::string flip = std::to_string(metrics.flip->mean);
  CHECK(has_line(text, "FLIP              mean " + flip + ", largest " + flip));
  CHECK(text.find("HDR-FLIP          mean 0.") != std::string::npos);
  CHECK(has_line(text, "  row 4, column 3   0.00000 % bit-equal, RMSE 1, max 1, FLIP " + flip));
  const nlohmann::ordered_json json = to_json(metrics);
  CHECK(json.at("flip").at("mean").get<double>() == metrics.flip->mean);
  CHECK(json.at("hdr_flip").at("exposures") == 1);
  CHECK(json.at("regions").at(3).at("flip").get<double>() == doctest::Approx(metrics.flip->mean));
}

TEST_CASE("pictures without a finite value have metrics that are said") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string text = table(compare::measure_in_detail(gray(nan), gray(nan), compare::MetricSet::all));
  CHECK(has_line(text, "ULP apart         no finite values"));
  CHECK(has_line(text, "FLIP              mean 1.000000, largest 1.000000"));
  CHECK(text.find("nan") == std::string::npos);
}

}  // namespace
}  // namespace tandem::tools
