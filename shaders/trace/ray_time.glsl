// A ray's time on its way to intersection shaders, which do not see the payload: it travels as the ray's t_min. A power of
// two makes it too small to matter there, and changes no bit of it.

#ifndef TANDEM_TRACE_RAY_TIME
#define TANDEM_TRACE_RAY_TIME

const float TIME_SCALE = 7.88860905e-31;  // 2^-100; times are multiples of 2^-24 below 1
const float TIME_SCALE_INVERSE = 1.26765060e30;

precise float t_min_of_time(float time) { return time * TIME_SCALE; }

precise float time_of_t_min(float t_min) { return t_min * TIME_SCALE_INVERSE; }

#endif
