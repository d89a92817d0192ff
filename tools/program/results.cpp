#include "tools/program/results.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/printable.hpp"
#include "program/data/npy.hpp"
#include "program/data/table.hpp"
#include "program/data/texels.hpp"
#include "program/reflect/shader_interface.hpp"
#include "tools/program/contents.hpp"
#include "tools/program/resource_words.hpp"

namespace tandem::tools::program_run {
namespace {

using program::ValueType;

/// Of a block with one member that member, which makes a table.
ValueType table_type(const BuiltJob& built, const Resource& resource) {
  const ValueType type = type_of(built, resource);
  return type.kind == ValueType::Kind::structure && !resource.is_image ? program::contents_type(type) : type;
}

const Resource& resource_named(const BuiltJob& built, const Setting& save) {
  std::string known;
  for (const Resource& each : built.resources) {
    if (each.key == save.key || std::ranges::count(each.names, save.key) != 0) return each;
    known += (known.empty() ? "" : ", ") + each.key;
  }
  refuse(save, fmt::format("there is no '{}' to save; there {}", shortened(save.key),
                           known.empty() ? "is nothing" : "are " + known));
}

/// Throws Error where a file of NumPy cannot hold the values.
void check_array(const BuiltJob& built, const Setting& save, const Resource& resource) {
  if (!save.value.ends_with(".npy")) return;
  const program::Job& job = built.job;
  try {
    program::npy_of(table_type(built, resource),
                    resource.is_image ? job.images[resource.index].initial : job.buffers[resource.index].initial);
  } catch (const Error& error) {
    refuse(save, error.what());
  }
}

std::string difference_text(const char* what, const std::string& prefix, const program::Difference& difference) {
  const std::string name = difference.path.empty() && prefix.empty() ? "the value" : prefix + difference.path;
  const bool is_number = difference.relative < std::numeric_limits<double>::infinity() && difference.ulp > 0;
  return fmt::format("    {:<6}  {}: {} against {}{}\n", what, name, difference.a, difference.b,
                     is_number ? fmt::format(" ({} ulp, {:.2g} relative)", difference.ulp, difference.relative) : "");
}

}  // namespace

ValueType type_of(const BuiltJob& built, const Resource& resource) {
  return resource.is_image ? program::texture_type(built.job.images[resource.index].desc)
                           : built.job.buffers[resource.index].type;
}

std::vector<OutputFile> result_files(const BuiltJob& built, const std::vector<Setting>& saves,
                                     const Contents& contents) {
  std::vector<OutputFile> files;
  for (const Setting& save : saves) {
    const Resource& resource = resource_named(built, save);
    check_extension(save, resource.is_image);
    check_array(built, save, resource);
    const auto position = static_cast<std::size_t>(&resource - built.resources.data());
    const auto write = [&built, &contents, &resource, position](const std::filesystem::path& path) {
      const bool is_image_file = resource.is_image && is_picture(path);
      AtomicFile file(path);
      file.write(is_image_file ? encode_picture(path, built.job.images[resource.index].desc, contents[position])
                               : encode_values(path, table_type(built, resource), contents[position]));
      file.commit();
    };
    files.push_back({save.folder / save.value, write});
  }
  return files;
}

std::string printed(const BuiltJob& built, const Contents& contents, std::size_t lines) {
  std::string text;
  for (std::size_t i = 0; i < built.resources.size(); ++i) {
    const Resource& resource = built.resources[i];
    if (!resource.is_written) continue;
    ValueType type = table_type(built, resource);
    // The rows of an image are an array of arrays: a line for each texel says more.
    std::span<const std::byte> bytes = contents[i];
    if (resource.is_image && type.kind == ValueType::Kind::array)
      type = program::make_array(program::texel_type(built.job.images[resource.index].desc.format), 0);
    text += fmt::format("{}: {}, {} bytes\n", resource.key, program::describe(type_of(built, resource)), bytes.size());
    text += program::to_columns(type, bytes, lines);
    const bool is_table = type.kind == ValueType::Kind::array;
    const std::uint64_t count =
        is_table ? bytes.size() / std::max(type.stride, 1u) : program::scalar_count(type, bytes.size());
    if (count > lines) text += fmt::format("  ... and {} more\n", count - lines);
  }
  return text;
}

std::vector<ResourceComparison> compared(const BuiltJob& built, const Contents& a, const Contents& b,
                                         const program::Tolerance& tolerance) {
  std::vector<ResourceComparison> comparisons;
  for (std::size_t i = 0; i < built.resources.size(); ++i)
    if (built.resources[i].is_written)
      comparisons.push_back({i, program::compare(type_of(built, built.resources[i]), a[i], b[i], tolerance)});
  return comparisons;
}

std::string text_of(const BuiltJob& built, const std::vector<ResourceComparison>& comparisons,
                    const program::Tolerance& tolerance) {
  std::string text;
  for (const auto& [position, values] : comparisons) {
    const Resource& resource = built.resources[position];
    text += fmt::format("  {:<16}  {} of {} values bit-equal", resource.key, values.bit_equal, values.scalars);
    if (values.bit_equal != values.scalars) {
      if (tolerance.ulp > 0 || tolerance.relative > 0 || values.within != values.bit_equal)
        text += fmt::format(", {} within the tolerance", values.within);
      text += fmt::format(", largest difference {} ulp, {:.3g} relative, {:.3g} absolute", values.largest_ulp,
                          values.largest_relative, values.largest_absolute);
      if (values.nan_a > 0 || values.nan_b > 0)
        text += fmt::format(", NaN in one alone: {} and {}", values.nan_a, values.nan_b);
    }
    text += "\n";
    if (values.disagreed)
      text += difference_text("first", resource.prefix, *values.disagreed);
    else if (values.first)
      text += difference_text("first", resource.prefix, *values.first);
    if (values.worst && values.first && values.worst->index != values.first->index)
      text += difference_text("worst", resource.prefix, *values.worst);
  }
  return text;
}

}  // namespace tandem::tools::program_run
