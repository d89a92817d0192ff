#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "program/job/job.hpp"
#include "rhi/shader_reflection.hpp"
#include "tools/program/resource_words.hpp"

/// First contents of resources, and files of their last ones. Functions with a setting throw Error, which begins with
/// what was asked for.
namespace tandem::tools::program_run {

/// The bytes of a buffer of the type, as many as the words say, at least as many as the type has.
std::vector<std::byte> buffer_contents(const Setting& setting, const BufferWords& words,
                                       const program::ValueType& type);

/// An image for the binding: the format and dimension of the shader where the words name none.
program::Image image_contents(const Setting& setting, const ImageWords& words, const rhi::ShaderBinding& binding);

/// Whether the file's extension is one that the two functions below know, and for images only.
bool is_picture(const std::filesystem::path& file);

/// A file of the bytes of a buffer: .bin or .raw, .npy, .csv, .txt. @param type of what is tabulated
std::vector<std::byte> encode_values(const std::filesystem::path& file, const program::ValueType& type,
                                     std::span<const std::byte> bytes);

/// A picture of the first level and layer of an image: .png (normalised texels as they are, others as linear colours)
/// or .exr.
std::vector<std::byte> encode_picture(const std::filesystem::path& file, const rhi::TextureDesc& desc,
                                      std::span<const std::byte> bytes);

/// Throws Error unless a result can be written into such a file.
void check_extension(const Setting& setting, bool is_image);

}  // namespace tandem::tools::program_run
