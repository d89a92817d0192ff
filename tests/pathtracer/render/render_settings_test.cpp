#include "pathtracer/render/render_settings.hpp"

#include <limits>
#include <string>

#include <doctest/doctest.h>

#include "base/error.hpp"

using namespace tandem::pathtracer;

namespace {

std::string error_of(const RenderSettings& settings) {
  try {
    check(settings);
  } catch (const tandem::Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("The first who says something counts") {
  SceneSettings command, file;
  command.samples = 64;
  file.samples = 4;
  file.sampler = SamplerKind::sobol;
  const SceneSettings both = merged(command, file);
  CHECK(both.samples == 64u);
  CHECK(both.sampler == SamplerKind::sobol);
  CHECK_FALSE(both.seed);
  const RenderSettings settings = render_settings(both);
  CHECK(settings.planned_samples == 64);
  CHECK(settings.sampler == SamplerKind::sobol);
  CHECK(settings.seed == RenderSettings().seed);
  CHECK(settings.mis == Mis::power);
}

TEST_CASE("Settings out of range are errors that say which") {
  CHECK(error_of({}) == "no error");
  CHECK(error_of({.width = 0}).find("0x512") != std::string::npos);
  CHECK(error_of({.max_depth = 0}).find("depth") != std::string::npos);
  CHECK(error_of({.planned_samples = 0}).find("samples") != std::string::npos);
  CHECK(error_of({.clamp_direct = -1}).find("direct") != std::string::npos);
  CHECK(error_of({.clamp_indirect = std::numeric_limits<float>::infinity()}).find("indirect") != std::string::npos);
  CHECK(error_of({.occlusion_length = 0}).find("occlusion") != std::string::npos);
  const auto metropolis_error = [](const MetropolisSettings& metropolis, SamplerKind sampler) {
    return error_of({.integrator = Integrator::metropolis, .metropolis = metropolis, .sampler = sampler});
  };
  constexpr SamplerKind usual = SamplerKind::independent;
  CHECK(metropolis_error({}, usual) == "no error");
  CHECK(metropolis_error({}, SamplerKind::sobol).find("sobol") != std::string::npos);
  CHECK(metropolis_error({.chains = 0}, usual).find("chains") != std::string::npos);
  CHECK(metropolis_error({.bootstrap_paths = 3}, usual).find("bootstrap") != std::string::npos);
  CHECK(metropolis_error({.large_step = 0}, usual).find("large steps") != std::string::npos);
}

TEST_CASE("Usual settings need no feature; every other one does") {
  CHECK(features_of(RenderSettings()) == 0);
  CHECK(features_of(RenderSettings{.integrator = Integrator::metropolis}) == 0);
  CHECK(features_of(RenderSettings{.sampler = SamplerKind::halton}) == feature::samplers);
  for (const RenderSettings& settings :
       {RenderSettings{.integrator = Integrator::direct}, RenderSettings{.light_sampling = false},
        RenderSettings{.mis = Mis::balance}, RenderSettings{.bsdf_sampling = BsdfSampling::cosine},
        RenderSettings{.roulette = false}, RenderSettings{.max_diffuse_depth = 1u},
        RenderSettings{.max_glossy_depth = 1u}, RenderSettings{.max_specular_depth = 1u},
        RenderSettings{.clamp_direct = 1}, RenderSettings{.clamp_indirect = 1}})
    CHECK(features_of(settings) == feature::options);
  Camera camera;
  CHECK(features_of(RenderSettings{.camera = camera}) == 0);
  camera.lens_radius = 1;
  CHECK(features_of(RenderSettings{.camera = camera}) == feature::cameras);
}

TEST_CASE("What is built has what is needed") {
  for (Features needed = 0; needed <= feature::all; ++needed) {
    const Features built = built_features(needed);
    CHECK((needed & ~built) == 0);
  }
  CHECK(built_features(0) == 0);
  CHECK(built_features(feature::transparency) == feature::transparency);
}

TEST_CASE("A specialisation names every feature") {
  const auto values = specialization(feature::spheres | feature::media);
  REQUIRE(values.size() == feature::count);
  for (std::uint32_t id = 0; id < feature::count; ++id) {
    CHECK(values[id].id == id);
    CHECK(values[id].value == (id == 1 || id == 8 ? 1 : 0));
  }
}
