#include "tests/family/forms.hpp"

#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>

#include <fmt/format.h>
#include <spirv-tools/optimizer.hpp>

#include "rhi/glsl/compile.hpp"
#include "rhi_cpu/kernel/abi.hpp"
#include "rhi_cpu/translate/compile_options.hpp"
#include "rhi_cpu/translate/translate.hpp"

namespace tandem::family {

namespace fs = std::filesystem;

namespace {

constexpr unsigned seconds_to_run = 20;

template <typename T>
void put(std::vector<std::byte>& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
}

float some_float(std::mt19937& random) { return static_cast<float>(static_cast<int>(random() % 4001) - 2000) / 64.0f; }

void fill(std::vector<std::byte>& bytes, std::mt19937& random, bool are_floats) {
  for (std::size_t i = 0; i + 4 <= bytes.size(); i += 4) {
    const auto word = static_cast<std::uint32_t>(random());
    if (are_floats)
      put(bytes, i, some_float(random));
    else
      put(bytes, i, (word & 3u) == 0 ? word : word % 97u);
  }
}

/// The item of generator.cpp, without padding.
void fill_items(std::vector<std::byte>& bytes, std::mt19937& random) {
  constexpr std::size_t words_of_floats[] = {0, 1, 2, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17};
  fill(bytes, random, false);
  for (std::size_t item = 0; item + item_bytes <= bytes.size(); item += item_bytes)
    for (const std::size_t word : words_of_floats) put(bytes, item + word * 4, some_float(random));
}

/// The results in a child's memory, or what became of it.
Results in_child(const fs::path& library, const ShaderData& data) {
  const std::size_t size = data.buffers[2].size() + data.buffers[3].size();
  void* shared = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw std::runtime_error("no memory for the results");
  const pid_t child = fork();
  if (child == 0) {
    alarm(seconds_to_run);
    void* loaded = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (loaded == nullptr) _exit(2);
    const auto entry = reinterpret_cast<kernel::EntryFunction>(dlsym(loaded, kernel::entry_symbol));
    const kernel::KernelInfo& info = *entry();
    ShaderData copy = data;
    std::vector<kernel::Resource> resources(info.resource_count);
    for (std::uint32_t i = 0; i < info.binding_count; ++i) {
      auto& buffer = copy.buffers[info.bindings[i].binding];
      resources[info.bindings[i].first_resource] = {buffer.data(), buffer.size()};
    }
    kernel::Dispatch dispatch{.resources = resources.data(), .push_constants = copy.push_constants.data()};
    std::copy(std::begin(workgroup_count), std::end(workgroup_count), dispatch.workgroup_count);
    info.run(dispatch, 0, std::uint64_t{workgroup_count[0]} * workgroup_count[1] * workgroup_count[2]);
    std::memcpy(shared, copy.buffers[2].data(), copy.buffers[2].size());
    std::memcpy(static_cast<std::byte*>(shared) + copy.buffers[2].size(), copy.buffers[3].data(),
                copy.buffers[3].size());
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  const auto* bytes = static_cast<const std::byte*>(shared);
  Results results(bytes, bytes + size);
  munmap(shared, size);
  if (WIFSIGNALED(status))
    throw Failure(WTERMSIG(status) == SIGALRM ? std::string("the kernel does not end")
                                              : fmt::format("the kernel ends with signal {}", WTERMSIG(status)));
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw Failure("the kernel cannot be loaded");
  return results;
}

}  // namespace

ShaderData data_for(const GeneratedShader& shader, std::uint32_t seed) {
  std::mt19937 random(seed);
  const std::size_t invocations = std::size_t{shader.workgroup_size[0]} * shader.workgroup_size[1] *
                                  shader.workgroup_size[2] * workgroup_count[0] * workgroup_count[1] *
                                  workgroup_count[2];
  ShaderData data;
  data.buffers.resize(5);
  data.buffers[0].resize(input_words * 4);
  data.buffers[1].resize(input_words * 4);
  data.buffers[2].resize(invocations * own_words * 4);
  data.buffers[3].resize(invocations * item_bytes);
  data.buffers[4].resize(256);
  fill(data.buffers[0], random, false);
  fill(data.buffers[1], random, true);
  fill(data.buffers[2], random, false);
  fill_items(data.buffers[3], random);
  fill(data.buffers[4], random, true);
  for (std::size_t i = 0; i < 64; i += 4) put(data.buffers[4], i, static_cast<std::uint32_t>(random() % 50));
  for (std::size_t i = 192; i < 256; i += 4) put(data.buffers[4], i, static_cast<std::uint32_t>(random() % 50));
  data.push_constants.resize(32);
  fill(data.push_constants, random, true);
  put(data.push_constants, 0, static_cast<std::uint32_t>(random() % 200));
  put(data.push_constants, 4, static_cast<std::int32_t>(random() % 200) - 100);
  put(data.push_constants, 12, static_cast<std::uint32_t>(random()));
  return data;
}

std::string name_of(const Form& form) {
  const std::string name = form.lanes == 0 ? "scalar" : fmt::format("{} lanes", form.lanes);
  return form.robust ? name + ", robust" : name;
}

std::vector<std::uint32_t> compiled(const ShaderTree& tree) {
  const pid_t child = fork();
  if (child == 0) {
    try {
      glsl::compile(printed(tree), rhi::ShaderStage::compute, "family.comp");
    } catch (const std::exception&) {
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) return {};
  return glsl::compile(printed(tree), rhi::ShaderStage::compute, "family.comp");
}

std::vector<std::uint32_t> optimized(const std::vector<std::uint32_t>& spirv, const std::string& pass) {
  if (pass.empty()) return spirv;
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
  optimizer.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t&, const char*) {});
  spvtools::OptimizerOptions options;
  options.set_run_validator(false);  // it would want to know of the scalar layout
  std::vector<std::uint32_t> result;
  if (!optimizer.RegisterPassesFromFlags({pass}) || !optimizer.Run(spirv.data(), spirv.size(), &result, options))
    throw Failure("spirv-opt " + pass + " fails");
  return result;
}

KernelRunner::KernelRunner(fs::path folder, std::string optimization)
    : folder_(std::move(folder)), optimization_(std::move(optimization)) {
  fs::create_directories(folder_);
}

/// The command that compiles kernels of so many lanes, with their headers precompiled.
std::string KernelRunner::prepared(std::uint32_t lanes) {
  std::string command = TANDEM_TEST_COMPILER " -shared -fPIC -march=native -I" TANDEM_SOURCE_DIRECTORY;
  for (const char* option : cpu::compile_options) command += std::string(" ") + option;
  command += " " + optimization_;
  const std::string header = (folder_ / fmt::format("prelude_{}.hpp", lanes)).string();
  if (prepared_.insert(lanes).second) {
    std::ofstream file(header);
    file << "#include \"rhi_cpu/kernel/kernel.hpp\"\n";
    if (lanes != 0) file << "#define TANDEM_LANES " << lanes << "\n#include \"rhi_cpu/kernel/wide/wide.hpp\"\n";
    file.close();
    if (std::system((command + " -x c++-header -o " + header + ".gch " + header).c_str()) != 0)
      throw std::runtime_error("the kernel headers do not compile");
  }
  return command + " -include " + header;
}

Results KernelRunner::run(const std::vector<std::uint32_t>& spirv, const Form& form, const ShaderData& data) {
  cpu::Translation translation;
  try {
    translation = cpu::translate(spirv, "family", {.robust = form.robust, .lanes = form.lanes});
  } catch (const std::exception& error) {
    throw Failure(std::string("the translator fails: ") + error.what());
  }
  const fs::path source = folder_ / "kernel.cpp", library = folder_ / "kernel.so", log = folder_ / "compiler.log";
  // A library that is still mapped must not change.
  fs::remove(library);
  std::ofstream(source) << translation.source;
  const std::string command =
      fmt::format("{} -o {} {} 2> {}", prepared(form.lanes), library.string(), source.string(), log.string());
  if (std::system(command.c_str()) != 0) {
    std::ifstream file(log);
    for (std::string line; std::getline(file, line);)
      if (const auto error = line.find("error: "); error != std::string::npos)
        throw Failure("the kernel does not compile: " + line.substr(error));
    throw Failure("the kernel does not compile");
  }
  return in_child(library, data);
}

Results run_on_device(rhi::Device& device, const std::vector<std::uint32_t>& spirv, const ShaderData& data) {
  const rhi::ShaderModuleHandle module = device.create_shader_module({.spirv = spirv, .label = "family"});
  const rhi::ComputePipelineHandle pipeline =
      device.create_compute_pipeline({.shader = module, .specialization = {}, .label = "family"});
  const rhi::CommandListHandle list = device.create_command_list("family");
  std::vector<rhi::BufferHandle> buffers;
  for (const auto& bytes : data.buffers) {
    buffers.push_back(device.create_buffer({.size = bytes.size(),
                                            .usage = rhi::BufferUsage::storage | rhi::BufferUsage::uniform,
                                            .label = fmt::format("buffer {}", buffers.size())}));
    list->upload(buffers.back(), 0, bytes);
  }
  rhi::BindGroupDesc bindings;
  bindings.pipeline = pipeline;
  bindings.label = "family";
  for (const rhi::ShaderBinding& each : module->reflection().bindings)
    bindings.entries.push_back({.binding = each.binding, .resource = rhi::BufferRange{buffers[each.binding]}});
  rhi::DispatchDesc dispatch;
  dispatch.pipeline = pipeline;
  if (!bindings.entries.empty()) dispatch.bind_groups = {device.create_bind_group(bindings)};
  dispatch.push_constants = std::span(data.push_constants).first(module->reflection().push_constant_size);
  std::copy(std::begin(workgroup_count), std::end(workgroup_count), dispatch.workgroup_count.begin());
  list->dispatch(dispatch);
  device.submit(list)->wait();
  Results results(data.buffers[2].size() + data.buffers[3].size());
  device.download(buffers[2], 0, std::span(results).first(data.buffers[2].size()));
  device.download(buffers[3], 0, std::span(results).subspan(data.buffers[2].size()));
  return results;
}

}  // namespace tandem::family
