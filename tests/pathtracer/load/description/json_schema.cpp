#include "tests/pathtracer/load/description/json_schema.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace tandem::test {
namespace {

using Json = nlohmann::json;

bool has_type(const Json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "number") return value.is_number();
  if (type == "integer") return value.is_number() && value.get<double>() == std::floor(value.get<double>());
  throw std::logic_error("type " + type);
}

bool has_all(const Json& object, const Json& keys) {
  return std::ranges::all_of(keys, [&](const Json& key) { return object.contains(key.get<std::string>()); });
}

bool in_range(const Json& schema, double value) {
  return value >= schema.value("minimum", -INFINITY) && value <= schema.value("maximum", INFINITY) &&
         value > schema.value("exclusiveMinimum", -INFINITY);
}

bool lists_members_of(const Json& schema, const Json& object) {
  if (schema.contains("required") && !has_all(object, schema["required"])) return false;
  if (schema.contains("dependentRequired"))
    for (const auto& [key, others] : schema["dependentRequired"].items())
      if (object.contains(key) && !has_all(object, others)) return false;
  return true;
}

/// Of a schema and all within it.
void check_keywords(const Json& schema) {
  static const std::set<std::string> known = {"$schema",
                                              "$defs",
                                              "$ref",
                                              "title",
                                              "description",
                                              "default",
                                              "type",
                                              "enum",
                                              "const",
                                              "properties",
                                              "required",
                                              "dependentRequired",
                                              "additionalProperties",
                                              "items",
                                              "prefixItems",
                                              "minItems",
                                              "maxItems",
                                              "minimum",
                                              "maximum",
                                              "exclusiveMinimum",
                                              "oneOf",
                                              "anyOf",
                                              "not"};
  if (!schema.is_object()) return;
  for (const auto& [keyword, value] : schema.items()) {
    if (!known.contains(keyword)) throw std::logic_error("keyword " + keyword);
    const bool by_name = keyword == "$defs" || keyword == "properties";
    const bool has_schemas = keyword == "oneOf" || keyword == "anyOf" || keyword == "prefixItems" || by_name;
    if (has_schemas)
      for (const Json& inner : value) check_keywords(inner);
    if (keyword == "items" || keyword == "not" || keyword == "additionalProperties") check_keywords(value);
  }
}

}  // namespace

JsonSchema::JsonSchema(Json root) : root_(std::move(root)) { check_keywords(root_); }

bool JsonSchema::accepts(const Json& schema, const Json& value) const {
  if (schema.is_boolean()) return schema.get<bool>();
  const auto accepts_value = [&](const Json& alternative) { return accepts(alternative, value); };
  if (schema.contains("$ref") &&
      !accepts(root_.at(Json::json_pointer(schema["$ref"].get<std::string>().substr(1))), value))
    return false;
  if (schema.contains("type") && !has_type(value, schema["type"].get<std::string>())) return false;
  if (schema.contains("const") && schema["const"] != value) return false;
  if (schema.contains("enum") && std::ranges::find(schema["enum"], value) == schema["enum"].end()) return false;
  if (schema.contains("not") && accepts(schema["not"], value)) return false;
  if (schema.contains("oneOf") && std::ranges::count_if(schema["oneOf"], accepts_value) != 1) return false;
  if (schema.contains("anyOf") && std::ranges::none_of(schema["anyOf"], accepts_value)) return false;
  if (value.is_number()) return in_range(schema, value.get<double>());
  if (value.is_array()) {
    const std::size_t size = value.size();
    if (size < schema.value("minItems", std::size_t{0}) || size > schema.value("maxItems", size)) return false;
    for (std::size_t i = 0; i < size; ++i) {
      const bool listed = schema.contains("prefixItems") && i < schema["prefixItems"].size();
      if (listed && !accepts(schema["prefixItems"][i], value[i])) return false;
      if (!listed && schema.contains("items") && !accepts(schema["items"], value[i])) return false;
    }
  }
  if (value.is_object()) {
    if (!lists_members_of(schema, value)) return false;
    for (const auto& [key, member] : value.items()) {
      const bool listed = schema.contains("properties") && schema["properties"].contains(key);
      if (listed && !accepts(schema["properties"][key], member)) return false;
      if (!listed && schema.contains("additionalProperties") && !accepts(schema["additionalProperties"], member))
        return false;
    }
  }
  return true;
}

const Json& JsonSchema::resolve(const Json& schema, const Json& value) const {
  if (schema.contains("$ref"))
    return resolve(root_.at(Json::json_pointer(schema["$ref"].get<std::string>().substr(1))), value);
  if (schema.contains("oneOf") && !schema.contains("type"))
    for (const Json& alternative : schema["oneOf"])
      if (accepts(alternative, value)) return resolve(alternative, value);
  return schema;
}

}  // namespace tandem::test
