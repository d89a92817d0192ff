#include "base/json_value.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/text_file.hpp"

namespace tandem::json {

// The library's own parser lets the last of several members of one name win.
nlohmann::json parse(const std::filesystem::path& path) {
  using Event = nlohmann::json::parse_event_t;
  std::vector<std::set<std::string>> open;  // the members so far of each object that is open
  const auto check = [&](int, Event event, const nlohmann::json& json) {
    if (event == Event::object_start) open.emplace_back();
    if (event == Event::object_end) open.pop_back();
    if (event == Event::key && !open.back().insert(json.get<std::string>()).second)
      throw Error(fmt::format("{}: an object has two members named {}", path.string(), json.get<std::string>()));
    return true;
  };
  const std::string text = read_text(path);
  try {
    return nlohmann::json::parse(text, check);
  } catch (const nlohmann::json::exception& error) {
    // Without the library's own mark, "[json.exception...] ".
    const std::string sentence = error.what();
    const std::size_t mark = sentence.find("] ");
    throw Error(fmt::format("{}: {}", path.string(), mark == std::string::npos ? sentence : sentence.substr(mark + 2)));
  }
}

std::string Range::sentence() const {
  if (above_minimum && minimum == 0 && maximum >= practically_unlimited) return "must be a positive number";
  if (above_minimum) return fmt::format("must be a number above {:g}, at most {:g}", minimum, maximum);
  if (minimum == 0 && maximum >= practically_unlimited) return "must be a number that is at least 0";
  if (maximum >= practically_unlimited) return "must be a finite number";
  return fmt::format("must be a number from {:g} to {:g}", minimum, maximum);
}

bool Range::contains(double value) const {
  return (above_minimum ? value > minimum : value >= minimum) && value <= maximum;
}

Value::Value(const nlohmann::json& json, std::string file, std::string path)
    : json_(&json), file_(std::move(file)), path_(std::move(path)) {}

void Value::fail(std::string_view sentence) const {
  throw Error(fmt::format("{}: {} {}", file_, path_.empty() ? "the description" : path_, sentence));
}

bool Value::is_array() const { return json_->is_array(); }
bool Value::is_object() const { return json_->is_object(); }
bool Value::is_string() const { return json_->is_string(); }

std::string Value::text() const {
  if (!json_->is_string()) fail("must be a text");
  return json_->get<std::string>();
}

bool Value::boolean() const {
  if (!json_->is_boolean()) fail("must be true or false");
  return json_->get<bool>();
}

double Value::double_number(const Range& range) const {
  if (!json_->is_number() || !range.contains(json_->get<double>())) fail(range.sentence());
  return json_->get<double>();
}

float Value::number(const Range& range) const {
  const float value = static_cast<float>(double_number(range));
  // Too small for a normal float: devices may take it for 0 or not.
  const bool tiny = value != 0 && std::abs(value) < std::numeric_limits<float>::min();
  if (range.above_minimum && !(value > static_cast<float>(range.minimum))) fail(range.sentence());
  if (tiny && range.above_minimum && range.minimum == 0) fail(range.sentence());
  return tiny ? 0.0f : value;
}

std::uint32_t Value::whole_number(std::uint32_t minimum, std::uint32_t maximum) const {
  // 4.0 is a whole number too, as in a JSON schema.
  const double value = json_->is_number() ? json_->get<double>() : std::nan("");
  if (!(value >= minimum && value <= maximum) || value != std::floor(value))
    fail(fmt::format("must be a whole number from {} to {}", minimum, maximum));
  return static_cast<std::uint32_t>(value);
}

glm::vec3 Value::vector(const Range& each) const {
  glm::vec3 result{0};
  const std::vector<Value> components = elements(3);
  for (int i = 0; i < 3; ++i) result[i] = components[static_cast<std::size_t>(i)].number(each);
  return result;
}

glm::vec3 Value::direction(const Range& each) const {
  const glm::vec3 result = vector(each);
  if (result == glm::vec3(0)) fail("must not be 0, 0, 0");
  return result;
}

glm::vec3 Value::color(const Range& each) const {
  if (json_->is_number()) return glm::vec3(number(each));
  if (!json_->is_array()) fail("must be a number or three");
  return vector(each);
}

std::vector<Value> Value::elements() const {
  if (!json_->is_array()) fail("must be a list");
  std::vector<Value> result;
  for (const nlohmann::json& element : *json_)
    result.emplace_back(element, file_, fmt::format("{}[{}]", path_, result.size()));
  return result;
}

std::vector<Value> Value::elements(std::size_t count) const {
  if (!json_->is_array() || json_->size() != count) fail(fmt::format("must be a list of {}", count));
  return elements();
}

std::vector<std::pair<std::string, Value>> Value::members() const {
  if (!json_->is_object()) fail("must be an object");
  std::vector<std::pair<std::string, Value>> result;
  for (const auto& [key, json] : json_->items())
    result.emplace_back(key, Value(json, file_, path_.empty() ? key : path_ + "." + key));
  return result;
}

Object::Object(Value value, std::vector<std::string> keys) : value_(std::move(value)), keys_(std::move(keys)) {
  for (const auto& [key, member] : value_.members())
    if (!knows(key)) member.fail(fmt::format("is not known; known here are: {}", fmt::join(keys_, ", ")));
}

bool Object::knows(const std::string& key) const { return std::ranges::find(keys_, key) != keys_.end(); }

std::optional<Value> Object::get(const std::string& key) const {
  if (!knows(key)) throw std::logic_error("undeclared member " + key);
  for (const auto& [name, member] : value_.members())
    if (name == key) return member;
  return std::nullopt;
}

Value Object::require(const std::string& key) const {
  std::optional<Value> member = get(key);
  if (!member) value_.fail("must have a " + key);
  return *std::move(member);
}

}  // namespace tandem::json
