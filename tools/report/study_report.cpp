#include "tools/report/study_report.hpp"

#include <fmt/format.h>

#include <iterator>

#include "pathtracer/scene/settings.hpp"
#include "tools/report/device_json.hpp"

namespace tandem::tools {
namespace {

using study::Measurement;
using study::MethodResult;

void add_ratio(std::string& text, const study::SampleRatio& sample_ratio) {
  const Measurement& thesis = sample_ratio.thesis.measurements.back();
  const Measurement& least = sample_ratio.best.measurements.front();
  const Measurement& most = sample_ratio.best.measurements.back();
  const auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "The thesis's method (no light sampling, cosine sampling, independent samples, no roulette) has an "
                 "RMSE of {:.4f} with {} samples. ",
                 thesis.rmse, thesis.samples);
  const std::optional<double> ratio = sample_ratio.ratio();
  if (!ratio) {
    fmt::format_to(out, "Light sampling, MIS and Sobol samples have {:.4f} with {}.\n\n", most.rmse, most.samples);
  } else {
    fmt::format_to(
        out, "Light sampling, MIS and Sobol samples reach that with **{}{:.0f} times fewer** ({:.4f} with {}).\n\n",
        least.rmse <= thesis.rmse ? "more than " : "", *ratio, least.rmse, least.samples);
  }
}

nlohmann::ordered_json to_json(const MethodResult& result) {
  const study::Method& method = result.method;
  nlohmann::ordered_json json;
  json["name"] = method.name;
  json["sampler"] = name_of(pathtracer::sampler_names(), method.sampler);
  json["light_sampling"] = method.light_sampling;
  json["mis"] = name_of(pathtracer::mis_names(), method.mis);
  json["bsdf_sampling"] = name_of(pathtracer::bsdf_sampling_names(), method.bsdf_sampling);
  json["roulette"] = method.roulette;
  json["slope"] = result.slope();
  json["variance"] = result.variance();
  json["efficiency"] = result.efficiency();
  json["measurements"] = nlohmann::ordered_json::array();
  for (const Measurement& measurement : result.measurements)
    json["measurements"].push_back(
        {{"samples", measurement.samples}, {"rmse", measurement.rmse}, {"seconds", measurement.seconds}});
  return json;
}

}  // namespace

std::string markdown(const StudyReport& report) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(
      out, "Measured on {} ({}) by `tandem study sampling`: {}x{} pixels, depth {}, errors against {} samples.\n\n",
      report.device.name, report.device.description, report.settings.size, report.settings.size,
      report.settings.max_depth, report.settings.reference_samples);
  for (const study::SceneResult& scene : report.scenes) {
    fmt::format_to(out, "### {}\n\n| {:<24} |", scene.scene, "method");
    for (const std::uint32_t samples : report.settings.sample_counts)
      fmt::format_to(out, " {:>9} |", fmt::format("RMSE {}", samples));
    fmt::format_to(out, " {:>6} | {:>8} | {:>7} | {:>10} |\n|--------------------------|", "slope", "variance",
                   "seconds", "efficiency");
    for (std::size_t i = 0; i < report.settings.sample_counts.size(); ++i) text += "----------:|";
    text += "-------:|---------:|--------:|-----------:|\n";
    for (const MethodResult& result : scene.methods) {
      fmt::format_to(out, "| {:<24} |", result.method.name);
      for (const Measurement& measurement : result.measurements) fmt::format_to(out, " {:>9.5f} |", measurement.rmse);
      fmt::format_to(out, " {:>6.2f} | {:>8.3g} | {:>7.2f} | {:>10.2f} |\n", result.slope(), result.variance(),
                     result.measurements.back().seconds, result.efficiency() / scene.methods.front().efficiency());
    }
    text += '\n';
    if (scene.sample_ratio) add_ratio(text, *scene.sample_ratio);
  }
  return text;
}

nlohmann::ordered_json to_json(const StudyReport& report) {
  nlohmann::ordered_json json;
  json["device"] = to_json(report.device);
  json["size"] = report.settings.size;
  json["depth"] = report.settings.max_depth;
  json["reference_samples"] = report.settings.reference_samples;
  json["scenes"] = nlohmann::ordered_json::array();
  for (const study::SceneResult& scene : report.scenes) {
    nlohmann::ordered_json methods = nlohmann::ordered_json::array();
    for (const MethodResult& result : scene.methods) methods.push_back(to_json(result));
    nlohmann::ordered_json entry = {{"scene", scene.scene}, {"methods", std::move(methods)}};
    if (scene.sample_ratio) {
      const std::optional<double> ratio = scene.sample_ratio->ratio();
      entry["thesis"] = to_json(scene.sample_ratio->thesis);
      entry["best"] = to_json(scene.sample_ratio->best);
      entry["sample_ratio"] = ratio ? nlohmann::ordered_json(*ratio) : nlohmann::ordered_json(nullptr);
    }
    json["scenes"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace tandem::tools
