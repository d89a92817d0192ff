// What evaluating and sampling a BSDF give.

#ifndef TANDEM_BSDF_BSDF_SAMPLE
#define TANDEM_BSDF_BSDF_SAMPLE

const uint LOBE_NONE = 0;  // nothing scattered: the path ends
const uint LOBE_DIFFUSE = 1;
const uint LOBE_SPECULAR = 2;      // the direction has no density: light sampling cannot find it
const uint LOBE_TRANSMISSION = 4;  // the direction is on the other side of the surface
const uint LOBE_GLOSSY = 8;        // it has a density, concentrated around one direction

struct BsdfSample {
  vec3 direction;  // unit, away from the surface, in the shading frame
  vec3 weight;     // BSDF * |cos| / density
  float density;   // per solid angle; 0 for a specular lobe
  uint lobe;       // LOBE_*
  float eta;       // index of refraction where `direction` lies over that of the other side; 1 if it stays
};

/// A BSDF for two directions.
struct BsdfValue {
  vec3 value;     // per steradian, without the cosine
  float density;  // of sampling the one, given the other
};

#endif
