#include "pathtracer/load/gltf/members.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"

namespace tandem::pathtracer {
namespace {

std::string whole_sentence(std::uint64_t least, std::uint64_t most) {
  if (most >= GltfMembers::largest_index) return fmt::format("must be a whole number that is at least {}", least);
  return fmt::format("must be a whole number from {} to {}", least, most);
}

}  // namespace

GltfMembers::GltfMembers(const std::string& file, std::string owner, std::string prefix, nlohmann::json& object)
    : file_(&file), owner_(std::move(owner)), prefix_(std::move(prefix)), object_(&object) {
  if (!object.is_object())
    throw Error(fmt::format("{}: {}{}{} must be an object", file, owner_, prefix_.empty() ? "" : ": ",
                            prefix_.substr(0, prefix_.empty() ? 0 : prefix_.size() - 1)));
}

void GltfMembers::fail(std::string_view sentence) const {
  throw Error(fmt::format("{}: {}: {}", *file_, owner_, sentence));
}

void GltfMembers::fail(const std::string& member, std::string_view must) const {
  fail(fmt::format("{}{} {}", prefix_, member, must));
}

bool GltfMembers::says(const std::string& member, std::string_view text) const {
  const auto entry = object_->find(member);
  return entry != object_->end() && entry->is_string() && entry->get_ref<const std::string&>() == text;
}

nlohmann::json* GltfMembers::find(const std::string& member, Need need) {
  const auto entry = object_->find(member);
  if (entry != object_->end()) return &*entry;
  if (need == Need::required) fail(member, "is missing");
  return nullptr;
}

nlohmann::json* GltfMembers::find_array(const std::string& member, Need need, std::string_view of_what) {
  nlohmann::json* array = find(member, need);
  if (array != nullptr && !array->is_array()) fail(member, fmt::format("must be an array of {}", of_what));
  return array;
}

void GltfMembers::make_whole(const std::string& member, nlohmann::json& value, std::uint64_t least,
                             std::uint64_t most) const {
  // Doubles from here on are no exact integers.
  constexpr double exact = 9007199254740992.0;
  if (value.is_number_float() && value.get<double>() >= 0 && value.get<double>() <= exact &&
      std::floor(value.get<double>()) == value.get<double>())
    value = static_cast<std::uint64_t>(value.get<double>());
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() < least || value.get<std::uint64_t>() > most)
    fail(member, whole_sentence(least, most));
}

void GltfMembers::whole(const std::string& member, Need need, std::uint64_t least, std::uint64_t most,
                        std::uint64_t step) {
  nlohmann::json* value = find(member, need);
  if (value == nullptr) return;
  make_whole(member, *value, least, most);
  if (value->get<std::uint64_t>() % step != 0)
    fail(member, fmt::format("must be a multiple of {}, not {}", step, value->get<std::uint64_t>()));
}

void GltfMembers::indices(const std::string& member, Need need) {
  if (nlohmann::json* array = find_array(member, need, "indices"))
    for (std::size_t i = 0; i < array->size(); ++i)
      make_whole(fmt::format("{}[{}]", member, i), (*array)[i], 0, largest_index);
}

void GltfMembers::one_of(const std::string& member, Need need, std::initializer_list<int> values) {
  nlohmann::json* value = find(member, need);
  if (value == nullptr) return;
  make_whole(member, *value, 0, unlimited);
  if (std::ranges::find(values, value->get<std::uint64_t>(), [](int v) { return static_cast<std::uint64_t>(v); }) ==
      values.end())
    fail(member, fmt::format("must be one of {}, not {}", fmt::join(values, ", "), value->get<std::uint64_t>()));
}

void GltfMembers::one_of(const std::string& member, Need need, std::initializer_list<std::string_view> values) {
  nlohmann::json* value = find(member, need);
  if (value == nullptr) return;
  if (!value->is_string()) fail(member, "must be a text");
  const std::string text = value->get<std::string>();
  if (std::ranges::find(values, std::string_view(text)) == values.end())
    fail(member, fmt::format("must be one of {}, not '{}'", fmt::join(values, ", "), text));
}

void GltfMembers::text(const std::string& member, Need need) {
  nlohmann::json* value = find(member, need);
  if (value != nullptr && !value->is_string()) fail(member, "must be a text");
}

void GltfMembers::texts(const std::string& member) {
  if (const nlohmann::json* array = find_array(member, Need::optional, "texts"))
    if (!std::ranges::all_of(*array, [](const nlohmann::json& value) { return value.is_string(); }))
      fail(member, "must be an array of texts");
}

void GltfMembers::flag(const std::string& member) {
  nlohmann::json* value = find(member, Need::optional);
  if (value != nullptr && !value->is_boolean()) fail(member, "must be true or false");
}

void GltfMembers::number(const std::string& member, Need need) {
  nlohmann::json* value = find(member, need);
  if (value != nullptr && !value->is_number()) fail(member, "must be a number");
}

void GltfMembers::numbers(const std::string& member, std::size_t count) {
  const std::string what = count == 0 ? "numbers" : fmt::format("{} numbers", count);
  const nlohmann::json* array = find_array(member, Need::optional, what);
  if (array == nullptr) return;
  const bool all = std::ranges::all_of(*array, [](const nlohmann::json& value) { return value.is_number(); });
  if (!all || (count > 0 && array->size() != count)) fail(member, fmt::format("must be an array of {}", what));
}

void GltfMembers::index_map(const std::string& member, Need need) {
  object(member, need, [](GltfMembers& map) {
    for (auto& [name, value] : map.object_->items()) map.make_whole(name, value, 0, largest_index);
  });
}

void GltfMembers::index_maps(const std::string& member) {
  objects(member, Need::optional, [](GltfMembers& map) {
    for (auto& [name, value] : map.object_->items()) map.make_whole(name, value, 0, largest_index);
  });
}

void GltfMembers::object(const std::string& member, Need need, const Check& check) {
  nlohmann::json* value = find(member, need);
  if (value == nullptr) return;
  GltfMembers members(*file_, owner_, prefix_ + member + ".", *value);
  check(members);
}

void GltfMembers::objects(const std::string& member, Need need, const Check& check) {
  nlohmann::json* array = find_array(member, need, "objects");
  if (array == nullptr) return;
  for (std::size_t i = 0; i < array->size(); ++i) {
    GltfMembers members(*file_, owner_, fmt::format("{}{}[{}].", prefix_, member, i), (*array)[i]);
    check(members);
  }
}

void GltfMembers::named_objects(const std::string& member, std::string_view kind, const Check& check) {
  nlohmann::json* array = find_array(member, Need::optional, "objects");
  if (array == nullptr) return;
  for (std::size_t i = 0; i < array->size(); ++i) {
    nlohmann::json& value = (*array)[i];
    const bool has_name = value.is_object() && value.contains("name") && value["name"].is_string();
    GltfMembers members(*file_, gltf_name(kind, i, has_name ? value["name"].get<std::string>() : ""), "", value);
    members.text("name");
    check(members);
  }
}

std::string gltf_name(std::string_view kind, std::size_t index, const std::string& name) {
  return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} {} ('{}')", kind, index, name);
}

}  // namespace tandem::pathtracer
