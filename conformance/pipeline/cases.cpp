#include "conformance/pipeline/cases.hpp"

namespace tandem::conformance {

void add_pipeline_cases(Cases& cases) {
  add_pipeline_builtin_cases(cases);
  add_pipeline_any_hit_cases(cases);
  add_pipeline_intersection_cases(cases);
  add_pipeline_ray_flags_cases(cases);
  add_pipeline_shader_table_cases(cases);
  add_pipeline_payload_cases(cases);
  add_pipeline_recursion_cases(cases);
  add_pipeline_callable_cases(cases);
  add_pipeline_launch_cases(cases);
  add_pipeline_resource_cases(cases);
  add_pipeline_against_query_cases(cases);
  add_pipeline_watertightness_cases(cases);
}

}  // namespace tandem::conformance
