#include <cstdlib>
#include <string>

#include <dlfcn.h>
#include <fmt/format.h>

#include "base/error.hpp"
#include "pathtracer/image/image_codec_module.hpp"

namespace tandem::pathtracer {
namespace {

/// Throws Error.
const ImageCodecModule& open_module() {
  const char* const chosen = std::getenv("TANDEM_IMAGE_CODEC");
  // A name without a slash is looked up in the run path of the program, which CMake gives to whatever links this
  // library.
  const std::string file = chosen != nullptr && *chosen != '\0' ? chosen : TANDEM_IMAGE_CODEC_FILE;
  const auto fail = [&](const std::string& why) {
    return Error(
        fmt::format("the library for pictures cannot be loaded: {} (TANDEM_IMAGE_CODEC may name its file)", why));
  };
  // Lazily, as the dynamic linker does it at the start of a program: hundreds of libraries have many symbols. Never
  // closed, because libraries behind it run threads.
  void* const library = ::dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) throw fail(::dlerror());
  const auto entry = reinterpret_cast<ImageCodecEntry>(::dlsym(library, image_codec_entry));
  if (entry == nullptr) throw fail(fmt::format("'{}' exports no {}", file, image_codec_entry));
  const ImageCodecModule& module = *entry();
  if (module.version != std::string_view(TANDEM_VERSION))
    throw fail(fmt::format("'{}' is of Tandem {}, this program of {}", file, module.version, TANDEM_VERSION));
  return module;
}

/// Opens it the first time; after a failure the next call tries again.
const ImageCodecModule& module() {
  static const ImageCodecModule& opened = open_module();
  return opened;
}

}  // namespace

void require_image_codec() { module(); }

std::vector<std::byte> encode_exr(std::uint32_t width, std::uint32_t height, std::span<const ImageChannel> channels,
                                  const ImageAttributes& attributes) {
  return module().encode_exr(width, height, channels, attributes);
}

std::vector<std::byte> encode_png(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgb,
                                  const ImageAttributes& attributes) {
  return module().encode_png(width, height, rgb, attributes);
}

DecodedImage decode_image(const std::filesystem::path& path) { return module().decode_path(path); }

DecodedImage decode_image(std::span<const std::byte> file) { return module().decode_bytes(file); }

}  // namespace tandem::pathtracer
