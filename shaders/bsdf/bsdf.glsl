// The BSDF of a material: its parameters at a point, and what they scatter.

#ifndef TANDEM_BSDF_BSDF
#define TANDEM_BSDF_BSDF

#include "bsdf/models.glsl"
#include "bsdf/parameters.glsl"

#endif
