#pragma once

#include "pathtracer/scene/scene.hpp"

/// The scenes of studies, made in memory so that a study needs no files. Each has its camera.
namespace tandem::study {

/// The Cornell box of Shirley's Ray Tracing: The Rest of Your Life (2020): two white blocks, a light that covers a
/// twentieth of the ceiling.
pathtracer::Scene weekend_box();

/// Veach's plates (Robust Monte Carlo Methods for Light Transport Simulation, 1997, figure 9.2), in our own measures:
/// four plates from polished to rough that mirror four spherical lights of the same power from small to large. Where
/// lights are small and plates rough, sampling lights is best; where it is the other way round, sampling the BSDF is.
pathtracer::Scene veach_plates();

/// A light of one triangle over a diffuse floor that fills the picture: what a pixel integrates is smooth.
pathtracer::Scene light_over_floor();

}  // namespace tandem::study
