#include "compare/study/sampling_study.hpp"

#include <cmath>

#include <doctest/doctest.h>

#include "compare/study/study_scenes.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using study::Measurement;
using study::MethodResult;
using study::SampleRatio;

namespace {

MethodResult measured(const std::vector<Measurement>& measurements) {
  return {.method = {}, .measurements = measurements};
}

}  // namespace

TEST_CASE("Slope, variance and efficiency follow from the measurements") {
  const MethodResult result = measured({{4, 0.5, 1}, {16, 0.25, 4}, {64, 0.125, 16}});
  CHECK(result.slope() == doctest::Approx(-0.5));
  CHECK(result.variance() == doctest::Approx(1.0));
  CHECK(result.efficiency() == doctest::Approx(4.0));
}

TEST_CASE("The ratio of samples is where the errors are equal") {
  const MethodResult thesis = measured({{4, 1, 1}, {1024, 0.1, 1}});
  // Half-way in the logarithm between 0.2 with 4 and 0.05 with 16 samples.
  CHECK(*SampleRatio{thesis, measured({{1, 0.4, 1}, {4, 0.2, 1}, {16, 0.05, 1}})}.ratio() == doctest::Approx(128));
  CHECK(*SampleRatio{thesis, measured({{1, 0.05, 1}, {4, 0.02, 1}})}.ratio() == doctest::Approx(1024));
  CHECK_FALSE(SampleRatio{thesis, measured({{1, 0.4, 1}, {4, 0.2, 1}})}.ratio().has_value());
}

TANDEM_DEVICE_TEST("Independent samples converge as N^-1/2, Sobol samples of a smooth picture faster") {
  const study::StudySettings settings{
      .size = 16, .max_depth = 2, .sample_counts = {4, 16, 64}, .reference_samples = 2048};
  const std::vector<study::Method> methods = {{.name = "independent"},
                                              {.name = "Sobol", .sampler = pathtracer::SamplerKind::sobol}};
  const std::optional<study::SceneResult> result =
      study::study_scene(device_handle, study::light_over_floor(), methods, settings, false);
  REQUIRE(result.has_value());
  // The errors of 256 pixels with three channels alike: the slope has a standard error of some 0.02.
  CHECK(result->methods[0].slope() == doctest::Approx(-0.5).epsilon(0.16));
  CHECK(result->methods[1].slope() < -0.8);
  CHECK(result->methods[1].efficiency() > result->methods[0].efficiency());
}

// The ratio grows with samples and with pixels, because edges of the light in the picture cost both methods the same:
// it is 21 with 32 x 32 pixels and 256 samples of the thesis's method.
TANDEM_DEVICE_TEST("Lights, MIS and Sobol need far fewer samples than the thesis's method in the Cornell box") {
  const study::StudySettings settings{.size = 16, .sample_counts = {4, 16}, .reference_samples = 1024};
  const std::optional<study::SceneResult> result =
      study::study_scene(device_handle, study::weekend_box(), {}, settings, true);
  REQUIRE(result.has_value());
  REQUIRE(result->sample_ratio.has_value());
  const std::optional<double> ratio = result->sample_ratio->ratio();
  REQUIRE(ratio.has_value());
  CHECK(*ratio >= 5);
}

TANDEM_DEVICE_TEST("A study that is cancelled has no result") {
  const study::StudySettings settings{.size = 4, .sample_counts = {1, 2}, .reference_samples = 4};
  CHECK_FALSE(study::study_scene(device_handle, study::weekend_box(), study::methods(), settings, true, [](double) {
                return false;
              }).has_value());
}
