#include "base/json_value.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/printable.hpp"
#include "base/text_file.hpp"

namespace tandem::json {

namespace {

/// Of values in values. What walks through them does so by recursion.
constexpr std::size_t deepest_nesting = 256;

/// What the library's own parser lets pass: of several members of one name it takes the last. Its callback for a parser
/// would see them too, but goes through all elements of a list after each of them.
class StrictReader : public nlohmann::json::json_sax_t {
 public:
  explicit StrictReader(const std::filesystem::path& path) : path_(path.string()) {}

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    if (!members_.back().insert(name).second)
      throw Error(fmt::format("{}: an object has two members named {}", path_, shortened(name)));
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& error) override {
    throw Error(fmt::format("{}: {}", path_, library_sentence(error)));
  }

 private:
  bool open() {
    members_.emplace_back();
    if (members_.size() > deepest_nesting)
      throw Error(fmt::format("{}: values are nested deeper than {} times", path_, deepest_nesting));
    return true;
  }
  bool close() {
    members_.pop_back();
    return true;
  }

  std::string path_;
  std::vector<std::set<std::string>> members_;  ///< so far, of each value that is open; those of a list stay empty
};

}  // namespace

std::string library_sentence(const std::exception& error) {
  const std::string_view sentence = error.what();
  const std::size_t mark = sentence.starts_with("[json.exception.") ? sentence.find("] ") : std::string_view::npos;
  return shortened(mark == std::string_view::npos ? sentence : sentence.substr(mark + 2), 200);
}

nlohmann::json parse(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  StrictReader reader(path);
  nlohmann::json::sax_parse(text, &reader);  // throws where it ends early
  return nlohmann::json::parse(text);
}

std::string Range::sentence() const {
  if (minimum <= -unlimited && maximum >= unlimited) return "must be a finite number";
  // A number that is too small for a normal float counts as 0.
  constexpr double smallest = 1.18e-38;
  if (above_minimum && minimum == 0) return fmt::format("must be a number from {:g} to {:g}", smallest, maximum);
  if (above_minimum) return fmt::format("must be a number above {:g}, at most {:g}", minimum, maximum);
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
bool Value::is_boolean() const { return json_->is_boolean(); }

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

glm::dvec3 Value::double_vector(const Range& each) const {
  glm::dvec3 result{0};
  const std::vector<Value> components = elements(3);
  for (int i = 0; i < 3; ++i) result[i] = components[static_cast<std::size_t>(i)].double_number(each);
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
    result.emplace_back(key, Value(json, file_, path_.empty() ? shortened(key) : path_ + "." + shortened(key)));
  return result;
}

Object::Object(Value value, std::vector<std::string> keys, std::vector<OldName> old_names)
    : value_(std::move(value)), keys_(std::move(keys)), old_names_(std::move(old_names)) {
  const auto members = value_.members();
  const auto is_member = [&](const std::string& key) {
    return std::ranges::any_of(members, [&](const auto& member) { return member.first == key; });
  };
  for (const auto& [name, member] : members) {
    const auto old = std::ranges::find(old_names_, name, &OldName::old);
    if (old != old_names_.end() && is_member(old->key))
      member.fail(fmt::format("is the old name of {}, which is there too", old->key));
    if (old == old_names_.end() && !knows(name))
      member.fail(fmt::format("is not known; known here are: {}", fmt::join(keys_, ", ")));
  }
}

bool Object::knows(const std::string& key) const { return std::ranges::find(keys_, key) != keys_.end(); }

std::optional<Value> Object::get(const std::string& key) const {
  if (!knows(key)) throw std::logic_error("undeclared member " + key);
  for (const auto& [name, member] : value_.members()) {
    const auto old = std::ranges::find(old_names_, name, &OldName::old);
    if (name == key || (old != old_names_.end() && old->key == key)) return member;
  }
  return std::nullopt;
}

Value Object::require(const std::string& key) const {
  std::optional<Value> member = get(key);
  if (!member) value_.fail("must have a " + key);
  return *std::move(member);
}

}  // namespace tandem::json
