// glTF 2.0's metallic-roughness material (specification, appendix B) with KHR_materials_ior, _specular and
// _transmission: a metal mixed with a diffuse base, or an infinitely thin sheet that lets light pass, under a
// dielectric reflection. The appendix's layering is changed where it would give back more light than arrives: the
// diffuse base gets what the reflection leaves of both directions, (1 - A(wo)) (1 - A(wi)) / (1 - mean A) with the
// albedo A of the reflection (Kelemen and Szirmay-Kalos, A Microfacet Based Coupled Specular-Matte BRDF Model,
// Eurographics 2001). So a white base gives back exactly what arrives. The metal's loss is compensated as in
// conductor.glsl, that of transmission is not. Directions are unit vectors in the shading frame and point away from the
// surface; wo is above it.

#ifndef TANDEM_BSDF_PRINCIPLED
#define TANDEM_BSDF_PRINCIPLED

#include "bsdf/bsdf_parameters.glsl"
#include "bsdf/bsdf_sample.glsl"
#include "bsdf/microfacet.glsl"
#include "bsdf/microfacet_albedo.glsl"

/// The parts of the material, and the probabilities with which they are sampled for one wo.
struct PrincipledLobes {
  vec3 normal_reflectance;   // of a facet: Schlick's f0
  vec3 grazing_reflectance;  // and f90
  float coat;                // the dielectric's f0, its largest channel
  float coat_grazing;        // and its f90
  float coat_albedo;         // of the dielectric reflection for wo
  float loss;                // of microfacet_albedo for wo
  float mean_loss;
  float coat_mean;  // mean of the coat's albedo
  vec3 diffuse;
  vec3 transmitted;
  vec3 compensation;
  float reflection_probability;
  float diffuse_probability;  // including compensation
  float transmission_probability;
  float diffuse_transmission_probability;  // of the sheet's compensation
};

precise float coat_albedo(float f0, float f90, MicrofacetAlbedo albedo) {
  return unit_clamp(f0 * (1.0 - albedo.loss - albedo.grazing) + f90 * albedo.grazing);
}

precise PrincipledLobes principled_lobes(BsdfParameters parameters, float alpha, vec3 wo) {
  PrincipledLobes lobes;
  float metallic = unit_clamp(parameters.metallic);
  float specular = unit_clamp(parameters.specular);
  float transmission = unit_clamp(parameters.transmission);
  float root = det_div(parameters.ior - 1.0, parameters.ior + 1.0);
  vec3 tinted = parameters.reflectance * (root * root);
  vec3 coat = vec3(unit_clamp(tinted.x), unit_clamp(tinted.y), unit_clamp(tinted.z)) * specular;
  lobes.normal_reflectance = coat * (1.0 - metallic) + parameters.base_color * metallic;
  lobes.grazing_reflectance = vec3(specular * (1.0 - metallic) + metallic);
  lobes.coat = max_component(coat);
  lobes.coat_grazing = specular;

  MicrofacetAlbedo mean = mean_microfacet_albedo(alpha);
  MicrofacetAlbedo albedo = microfacet_albedo(wo.z, alpha);
  lobes.coat_albedo = coat_albedo(lobes.coat, specular, albedo);
  lobes.coat_mean = coat_albedo(lobes.coat, specular, mean);
  lobes.loss = albedo.loss;
  lobes.mean_loss = mean.loss;
  lobes.diffuse = parameters.base_color * ((1.0 - metallic) * (1.0 - transmission));
  lobes.transmitted = parameters.base_color * ((1.0 - metallic) * transmission);
  lobes.compensation = vec3(compensation_color(parameters.base_color.x, mean.loss),
                            compensation_color(parameters.base_color.y, mean.loss),
                            compensation_color(parameters.base_color.z, mean.loss)) *
                       metallic;

  float reflection = coat_albedo(max_component(lobes.normal_reflectance), lobes.grazing_reflectance.x, albedo);
  float diffuse =
      max_component(lobes.diffuse) * (1.0 - lobes.coat_albedo) + max_component(lobes.compensation) * albedo.loss;
  float passing = max_component(lobes.transmitted);
  float transmitted = passing * unit_clamp((1.0 - albedo.loss) - lobes.coat_albedo);
  float diffuse_transmitted = passing * albedo.loss;
  precise float sum = (reflection + diffuse) + (transmitted + diffuse_transmitted);
  float scale = sum > 1e-10 ? det_div(1.0, sum) : 0.0;
  lobes.reflection_probability = reflection * scale;
  lobes.diffuse_probability = diffuse * scale;
  lobes.transmission_probability = transmitted * scale;
  lobes.diffuse_transmission_probability = diffuse_transmitted * scale;
  return lobes;
}

/// `facets`: between wo and wi, or where wi is below the surface, its mirror image above it.
precise BsdfValue principled_value(PrincipledLobes lobes, float alpha, Facets facets, vec3 wi) {
  float schlick = schlick_factor(facets.cosine_o);
  MicrofacetAlbedo albedo = microfacet_albedo(abs(wi.z), alpha);
  float compensation = compensation_value(lobes.loss, albedo.loss, lobes.mean_loss);
  if (wi.z < 0.0) {
    float passing = 1.0 - (lobes.coat + (lobes.coat_grazing - lobes.coat) * schlick);
    return BsdfValue(lobes.transmitted * (passing * (0.25 * facets.shape) + compensation),
                     lobes.transmission_probability * reflection_density(facets) -
                         lobes.diffuse_transmission_probability * (wi.z * INV_PI));
  }
  float uncoated_mean = 1.0 - lobes.coat_mean;
  float base = INV_PI * det_div((1.0 - lobes.coat_albedo) * (1.0 - coat_albedo(lobes.coat, lobes.coat_grazing, albedo)),
                                uncoated_mean > 1e-6 ? uncoated_mean : 1e-6);
  vec3 reflectance = lobes.normal_reflectance + (lobes.grazing_reflectance - lobes.normal_reflectance) * schlick;
  return BsdfValue(
      reflectance * (0.25 * facets.shape) + lobes.diffuse * base + lobes.compensation * compensation,
      lobes.reflection_probability * reflection_density(facets) + lobes.diffuse_probability * (wi.z * INV_PI));
}

#endif
