#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace tandem::pathtracer {

enum class Need { optional, required };

/// The members of an object in the JSON of a glTF file. Each function throws Error, naming file, object and member,
/// for a member that is of another type or out of range, or is required and absent. Whole numbers may be written with
/// a fraction of 0 or an exponent (glTF 2.0, section 2.7); they become integers in the JSON.
class GltfMembers {
 public:
  static constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();
  static constexpr std::uint64_t largest_index = 0x7fffffff;
  using Check = std::function<void(GltfMembers&)>;

  /// Throws Error where `object` is none. @param owner "accessor 3"  @param prefix of members: "sparse.", or ""
  GltfMembers(const std::string& file, std::string owner, std::string prefix, nlohmann::json& object);

  bool has(const std::string& member) const { return object_->contains(member); }
  /// Whether a member is this text.
  bool says(const std::string& member, std::string_view text) const;
  /// For an object that contradicts itself.
  [[noreturn]] void fail(std::string_view sentence) const;

  /// @param step that the number is a multiple of
  void whole(const std::string& member, Need need, std::uint64_t least = 0, std::uint64_t most = unlimited,
             std::uint64_t step = 1);
  void index(const std::string& member, Need need = Need::optional) { whole(member, need, 0, largest_index); }
  void indices(const std::string& member, Need need = Need::optional);
  void one_of(const std::string& member, Need need, std::initializer_list<int> values);
  void one_of(const std::string& member, Need need, std::initializer_list<std::string_view> values);
  void text(const std::string& member, Need need = Need::optional);
  void texts(const std::string& member);
  void flag(const std::string& member);
  void number(const std::string& member, Need need = Need::optional);
  /// @param count of numbers, 0: any
  void numbers(const std::string& member, std::size_t count);
  /// An object whose members are indices, such as the attributes of a primitive.
  void index_map(const std::string& member, Need need = Need::optional);
  void object(const std::string& member, Need need, const Check& check);
  /// An array of objects that belong to this one: "primitives[2]."
  void objects(const std::string& member, Need need, const Check& check);
  /// An array of objects that are called by `kind`, their index and name.
  void named_objects(const std::string& member, std::string_view kind, const Check& check);
  /// An array of maps from names to indices.
  void index_maps(const std::string& member);

 private:
  nlohmann::json* find(const std::string& member, Need need);
  nlohmann::json* find_array(const std::string& member, Need need, std::string_view of_what);
  [[noreturn]] void fail(const std::string& member, std::string_view must) const;
  void make_whole(const std::string& member, nlohmann::json& value, std::uint64_t least, std::uint64_t most) const;

  const std::string* file_;
  std::string owner_;
  std::string prefix_;
  nlohmann::json* object_;
};

/// "mesh 2 ('vase')": how messages call an object.
std::string gltf_name(std::string_view kind, std::size_t index, const std::string& name);

}  // namespace tandem::pathtracer
