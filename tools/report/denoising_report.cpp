#include "tools/report/denoising_report.hpp"

#include <fmt/format.h>

#include <iterator>

#include "tools/report/device_json.hpp"

namespace tandem::tools {
namespace {

nlohmann::ordered_json to_json(const study::PictureError& error) {
  return {{"rmse", error.rmse}, {"flip", error.flip}, {"hdr_flip", error.hdr_flip}, {"mean", error.mean}};
}

}  // namespace

std::string markdown(const DenoisingReport& report) {
  const study::DenoisingSettings& settings = report.settings;
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "Measured on {} ({}) by `tandem study denoising`: {}x{} pixels, {} samples per pixel, errors against "
                 "{} samples of other random numbers.\n\n"
                 "| scene | RMSE noisy | denoised | times less | FLIP noisy | denoised | HDR-FLIP noisy | denoised | "
                 "mean noisy | denoised | RMSE, fireflies kept | render ms | denoise ms |\n"
                 "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
                 report.device.name, report.device.description, settings.size, settings.size, settings.samples,
                 settings.reference_samples);
  for (const study::DenoisedScene& scene : report.scenes)
    fmt::format_to(out,
                   "| {} | {:.4f} | {:.4f} | **{:.1f}** | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.4f} "
                   "| {:.0f} | {:.0f} |\n",
                   scene.scene, scene.noisy.rmse, scene.denoised.rmse, scene.noisy.rmse / scene.denoised.rmse,
                   scene.noisy.flip, scene.denoised.flip, scene.noisy.hdr_flip, scene.denoised.hdr_flip,
                   scene.noisy.mean, scene.denoised.mean, scene.with_fireflies.rmse, scene.render_milliseconds,
                   scene.denoise_milliseconds);
  return text;
}

nlohmann::ordered_json to_json(const DenoisingReport& report) {
  nlohmann::ordered_json json;
  json["device"] = to_json(report.device);
  json["size"] = report.settings.size;
  json["samples"] = report.settings.samples;
  json["reference_samples"] = report.settings.reference_samples;
  json["scenes"] = nlohmann::ordered_json::array();
  for (const study::DenoisedScene& scene : report.scenes)
    json["scenes"].push_back({{"scene", scene.scene},
                              {"noisy", to_json(scene.noisy)},
                              {"denoised", to_json(scene.denoised)},
                              {"with_fireflies", to_json(scene.with_fireflies)},
                              {"render_milliseconds", scene.render_milliseconds},
                              {"denoise_milliseconds", scene.denoise_milliseconds}});
  return json;
}

}  // namespace tandem::tools
