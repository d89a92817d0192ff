// How much of the light a rough reflector gives back after one reflection from its facets, and a lobe that gives back
// what the facets keep among themselves. The numbers are from scripts/fit_microfacet_albedo.py: largest errors 0.005 of
// the loss, 0.008 of the grazing part.

#ifndef TANDEM_BSDF_MICROFACET_ALBEDO
#define TANDEM_BSDF_MICROFACET_ALBEDO

#include "bsdf/fresnel.glsl"

/// With the reflectance f0 + (f90 - f0) (1 - cos)^5 of a facet, a surface reflects the fraction
/// f0 (1 - loss - grazing) + f90 grazing.
struct MicrofacetAlbedo {
  float loss;
  float grazing;
};

precise float unit_clamp(float x) { return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0; }

/// `cosine`: of the direction of incidence, positive.
precise MicrofacetAlbedo microfacet_albedo(float cosine, float alpha) {
  float x = det_div(cosine, cosine + alpha);
  float s0 = 0.22601 + alpha * (0.218424 + alpha * (4.51552 + alpha * -0.448545));
  float s1 = -0.19778 + alpha * (4.83449 + alpha * (-21.1124 + alpha * -7.84354));
  float s2 = 4.2122 + alpha * (-38.2984 + alpha * (124.486 + alpha * 45.1245));
  float s3 = -0.916988 + alpha * (71.5674 + alpha * (-184.653 + alpha * -181.761));
  float s4 = -3.05292 + alpha * (-34.2437 + alpha * (99.0149 + alpha * 199.394));
  precise float loss = unit_clamp(x * ((1.0 - x) * (1.0 - x)) * (s0 + x * (s1 + x * (s2 + x * (s3 + x * s4)))));
  float r = det_sqrt(alpha);
  float g0 = 1.05106 + r * (-2.0838 + r * (1.3586 + r * -0.112947));
  float g1 = -0.24195 + r * (2.14174 + r * (-3.67695 + r * 1.40838));
  float g2 = -1.09915 + r * (8.31965 + r * (-15.5196 + r * 12.8588));
  float g3 = 2.65088 + r * (-15.5717 + r * (9.10667 + r * -6.28355));
  float g4 = -1.3557 + r * (7.47048 + r * (9.96242 + r * 26.017));
  float series = g0 + x * (g1 + x * (g2 + x * (g3 + x * g4)));
  precise float grazing = unit_clamp(det_div(schlick_factor(cosine) * series, 1.0 + 3.0 * alpha));
  return MicrofacetAlbedo(loss, grazing < 1.0 - loss ? grazing : 1.0 - loss);
}

/// 2 * integral of microfacet_albedo(cosine) * cosine.
precise MicrofacetAlbedo mean_microfacet_albedo(float alpha) {
  float r = det_sqrt(alpha);
  float loss =
      alpha * alpha * (5.81758 + r * (-18.7592 + r * (46.3832 + r * (-74.221 + r * (59.9338 + r * -18.5667)))));
  float grazing = 0.0462856 + r * (0.0654439 + r * (-0.51379 + r * (0.684746 + r * -0.278698)));
  return MicrofacetAlbedo(loss, grazing);
}

/// What light that facets with the reflectance f0 at normal incidence pass among themselves gives in all, as a fraction
/// of the loss: reflected once more with Schlick's mean reflectance, lost again by its mean, and so on (Kulla and
/// Conty, Revisiting Physically Based Shading at Imageworks, SIGGRAPH 2017 course).
precise float compensation_color(float f0, float mean_loss) {
  float mean_reflectance = (20.0 * unit_clamp(f0) + 1.0) * 0.0476190485;
  return det_div(mean_reflectance * mean_reflectance * (1.0 - mean_loss), 1.0 - mean_reflectance * mean_loss);
}

/// A BSDF that reflects the fraction loss_o of what comes from wo, and is symmetric in wo and wi.
precise float compensation_value(float loss_o, float loss_i, float mean_loss) {
  return INV_PI * det_div(loss_o * loss_i, mean_loss);
}

#endif
