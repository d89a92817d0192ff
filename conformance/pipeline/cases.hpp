#pragma once

#include "conformance/kit/cases.hpp"

/// The groups of the ray tracing pipeline; each function appends its cases.
namespace tandem::conformance {

void add_pipeline_builtin_cases(Cases& cases);
void add_pipeline_any_hit_cases(Cases& cases);
void add_pipeline_intersection_cases(Cases& cases);
void add_pipeline_ray_flags_cases(Cases& cases);
void add_pipeline_shader_table_cases(Cases& cases);
void add_pipeline_payload_cases(Cases& cases);
void add_pipeline_recursion_cases(Cases& cases);
void add_pipeline_callable_cases(Cases& cases);
void add_pipeline_launch_cases(Cases& cases);
void add_pipeline_resource_cases(Cases& cases);
void add_pipeline_against_query_cases(Cases& cases);
void add_pipeline_watertightness_cases(Cases& cases);

}  // namespace tandem::conformance
