#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>

#include "base/error.hpp"
#include "base/named.hpp"
#include "base/printable.hpp"

namespace tandem::json {

/// A limit from here on is none but that of floating point.
inline constexpr double unlimited = 1e300;

/// Reads a JSON file. Throws Error, naming the file, also for objects with two members of one name and for values that
/// are nested deeper than any file that is meant for us.
nlohmann::json parse(const std::filesystem::path& path);

/// What an exception of the JSON library says, without its own mark "[json.exception...]", and not at any length.
std::string library_sentence(const std::exception& error);

/// What a number must be.
struct Range {
  double minimum = std::numeric_limits<double>::lowest();
  double maximum = std::numeric_limits<double>::max();
  bool above_minimum = false;  ///< the minimum itself is out of range

  std::string sentence() const;  ///< "must be a number from 0 to 1"
  bool contains(double value) const;
};

inline constexpr Range fraction{0, 1, false};

/// A value of a JSON file that knows where it stands. Every accessor throws Error, naming the place, for a
/// value of another type or out of range.
class Value {
 public:
  /// @param file for messages  @param path within it, as in "spheres[2].radius"; "" is the whole. The JSON must
  /// outlive this object and what comes from it.
  Value(const nlohmann::json& json, std::string file, std::string path);

  /// "scene.json: spheres[2].radius <sentence>"
  [[noreturn]] void fail(std::string_view sentence) const;
  const std::string& file() const noexcept { return file_; }

  bool is_array() const;
  bool is_object() const;
  bool is_string() const;
  bool is_boolean() const;

  std::string text() const;
  bool boolean() const;
  float number(const Range& range) const;
  double double_number(const Range& range) const;  ///< as it is written, not rounded to a float
  std::uint32_t whole_number(std::uint32_t minimum, std::uint32_t maximum) const;
  /// [x, y, z]
  glm::vec3 vector(const Range& each) const;
  glm::dvec3 double_vector(const Range& each) const;  ///< as it is written, not rounded to floats
  /// [x, y, z], not all 0
  glm::vec3 direction(const Range& each) const;
  /// [r, g, b] or one number for all three; linear, with the primaries of sRGB.
  glm::vec3 color(const Range& each) const;
  /// One of the names.
  template <typename T>
  T choice(std::span<const Named<T>> names) const {
    const std::string given = text();
    std::string known;
    for (const Named<T>& named : names) {
      if (given == named.name) return named.value;
      known += (known.empty() ? "" : ", ") + std::string(named.name);
    }
    fail(fmt::format("is '{}', which is none of: {}", shortened(given), known));
  }

  std::vector<Value> elements() const;                         ///< of an array
  std::vector<Value> elements(std::size_t count) const;        ///< of an array of this length
  std::vector<std::pair<std::string, Value>> members() const;  ///< of an object with names of the user's own

 private:
  const nlohmann::json* json_;
  std::string file_;
  std::string path_;
};

/// An object whose members have fixed names.
class Object {
 public:
  /// A key and the name that it had before, which files may still use.
  struct OldName {
    std::string old;
    std::string key;
  };

  /// Throws Error when the value is no object, has a member that is not among `keys`, which the sentence then lists, or
  /// has one twice, by both of its names.
  Object(Value value, std::vector<std::string> keys, std::vector<OldName> old_names = {});

  const Value& value() const noexcept { return value_; }
  bool knows(const std::string& key) const;  ///< it is among `keys`
  /// Throws std::logic_error for a key that is not among `keys`: so the list is complete.
  std::optional<Value> get(const std::string& key) const;
  /// Throws Error when it is absent.
  Value require(const std::string& key) const;

  /// Reads a member into `target`, where it is there, by a member function of Value.
  template <typename Target, typename Result, typename... Parameters, typename... Arguments>
  void read(const std::string& key, Target& target, Result (Value::*accessor)(Parameters...) const,
            Arguments&&... arguments) const {
    if (const std::optional<Value> member = get(key))
      target = (*member.*accessor)(std::forward<Arguments>(arguments)...);
  }

 private:
  Value value_;
  std::vector<std::string> keys_;
  std::vector<OldName> old_names_;
};

/// The member "type" of an object, which decides which other members it may have. @param fallback where it is absent;
/// nothing: it is required
template <typename T>
T type_of(const Value& object, std::span<const Named<T>> names, const std::string& key = "type",
          std::optional<T> fallback = {}) {
  for (const auto& [name, value] : object.members())
    if (name == key) return value.choice(names);
  if (fallback) return *fallback;
  object.fail(fmt::format("must have a {}", key));
}

}  // namespace tandem::json
