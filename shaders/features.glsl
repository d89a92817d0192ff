// What a scene and its settings need of the path tracer, as specialisation constants: what is off leaves no trace in the
// code that a device runs. pathtracer/render/features.hpp says the same on the host and which sets of them are built in. A
// feature that is on and not used changes no bit of the picture.

#ifndef TANDEM_FEATURES
#define TANDEM_FEATURES

layout(constant_id = 0) const bool FEATURE_TRANSPARENCY = false;  // materials that let rays pass (geometry/opacity.glsl)
layout(constant_id = 1) const bool FEATURE_SPHERES = false;       // analytic spheres
layout(constant_id = 2) const bool FEATURE_TEXTURES = false;      // textures, pigments, normal and bump maps
layout(constant_id = 3) const bool FEATURE_MATERIALS = false;     // models beyond Lambert, mirror and smooth dielectric
layout(constant_id = 4) const bool FEATURE_LIGHTS = false;        // lights beyond emissive triangles
layout(constant_id = 5) const bool FEATURE_CAMERAS = false;       // cameras beyond the still pinhole
layout(constant_id = 6) const bool FEATURE_SAMPLERS = false;      // samplers beyond independent random numbers
layout(constant_id = 7) const bool FEATURE_OPTIONS = false;       // options of the integrator that are not the defaults
layout(constant_id = 8) const bool FEATURE_MEDIA = false;         // participating media

#endif
