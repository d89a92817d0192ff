# Shaders that ship: GLSL is compiled to SPIR-V, embedded, translated to C++ and compiled while the project is built.
include_guard()

# The options of rhi_cpu/translate/compile_options.hpp, so that the build and the run-time compiler use the same ones.
file(STRINGS "${CMAKE_CURRENT_LIST_DIR}/../rhi_cpu/translate/compile_options.hpp" TANDEM_KERNEL_OPTIONS REGEX "^ *\"-.*\",")
list(TRANSFORM TANDEM_KERNEL_OPTIONS REPLACE "^ *\"([^\"]*)\".*" "\\1")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
                                       "${CMAKE_CURRENT_LIST_DIR}/../rhi_cpu/translate/compile_options.hpp")

# tandem_add_shaders(NAME SOURCES a.comp b.rgen ... [INCLUDE_DIRECTORIES ...] [SPECIALIZATIONS "0=1" "0=1,3=2" ...]
#                    [WITHOUT_KERNELS b.rgen ...])
#
# Sources are compute shaders (.comp) and the stages of ray tracing pipelines (.rgen .rmiss .rchit .rahit .rint .rcall).
# For each (relative to the current directory) the function of its name without extension, e.g. render.comp, and with the
# extension for a ray tracing stage, which shares its name with the others of its pipeline: trace.rgen is trace_rgen.
#   tandem_NAME (alias Tandem::NAME), header "NAME/spirv.hpp":
#     namespace tandem::NAME { std::span<const std::uint32_t> render(); }   the SPIR-V, for every backend
#   tandem_NAME_kernels (alias Tandem::NAME_kernels), header "NAME/kernels.hpp":
#     namespace tandem::NAME { std::span<const cpu::PrecompiledKernel> kernels(); }   all of them, for the CPU device
#
# Each of SPECIALIZATIONS is a set of constant=value for which kernels are made of every source, or with @REGEX behind it of
# those whose names match, beside the kernels with the defaults: others have to be compiled when they are used.
#
# WITHOUT_KERNELS: sources of which there is no kernel.
#
# SPIR-V keeps its debug information, so that a debugger shows the GLSL. A shader is rebuilt when it or anything that it
# includes has changed.
function(tandem_add_shaders name)
  cmake_parse_arguments(PARSE_ARGV 1 shaders "" "" "SOURCES;INCLUDE_DIRECTORIES;SPECIALIZATIONS;WITHOUT_KERNELS")
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${name}.generated")
  set(include_options)
  foreach(directory IN LISTS shaders_INCLUDE_DIRECTORIES)
    cmake_path(ABSOLUTE_PATH directory BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    list(APPEND include_options "-I${directory}")
  endforeach()

  set(words_sources)
  set(kernel_sources)
  set(word_declarations)
  set(entry_declarations)
  set(kernel_entries)
  set(specialization_values)
  set(number 0)
  foreach(values IN LISTS shaders_SPECIALIZATIONS)
    math(EXPR number "${number} + 1")
    string(REGEX REPLACE "@.*" "" values "${values}")
    string(REGEX REPLACE "([0-9]+)=([0-9]+)" "{\\1, \\2}" initializers "${values}")
    string(APPEND specialization_values "  static constexpr rhi::SpecializationValue specialization_${number}[] = {${initializers}};\n")
  endforeach()
  foreach(source IN LISTS shaders_SOURCES)
    cmake_path(GET source STEM shader)
    cmake_path(GET source EXTENSION LAST_ONLY stage)
    if(NOT stage STREQUAL ".comp")
      string(APPEND shader "${stage}")
    endif()
    string(MAKE_C_IDENTIFIER "${shader}" shader)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE OUTPUT_VARIABLE path)
    set(spirv "${folder}/${shader}.spv")
    set(entry "tandem_kernel_${name}_${shader}")
    add_custom_command(
      OUTPUT "${spirv}"
      COMMAND "${CMAKE_COMMAND}" -E make_directory "${folder}"
      COMMAND "${TANDEM_GLSLANG}" --quiet -V -g --target-env vulkan1.2 ${include_options} --depfile "${spirv}.d" -o "${spirv}" "${path}"
      DEPENDS "${path}"
      DEPFILE "${spirv}.d"
      COMMENT "GLSL to SPIR-V: ${source}"
      VERBATIM)
    add_custom_command(
      OUTPUT "${folder}/${shader}_words.cpp" "${folder}/${shader}_kernel.cpp"
      COMMAND tandem-translate "${spirv}" --embed "${folder}/${shader}_words.cpp" --namespace "tandem::${name}" --name "${shader}"
              --kernel "${folder}/${shader}_kernel.cpp" --entry-symbol "${entry}"
      DEPENDS "${spirv}" tandem-translate
      COMMENT "SPIR-V to C++: ${source}"
      VERBATIM)
    list(APPEND words_sources "${folder}/${shader}_words.cpp")
    string(APPEND word_declarations "std::span<const std::uint32_t> ${shader}();\n")
    if(source IN_LIST shaders_WITHOUT_KERNELS)
      continue()
    endif()
    list(APPEND kernel_sources "${folder}/${shader}_kernel.cpp")
    string(APPEND entry_declarations "extern \"C\" const tandem::kernel::KernelInfo* ${entry}();\n")
    string(APPEND kernel_entries "      {${shader}(), ${entry}},\n")
    set(number 0)
    foreach(values IN LISTS shaders_SPECIALIZATIONS)
      math(EXPR number "${number} + 1")
      if(values MATCHES "(.*)@(.*)")
        set(values "${CMAKE_MATCH_1}")
        if(NOT source MATCHES "${CMAKE_MATCH_2}")
          continue()
        endif()
      endif()
      string(REGEX REPLACE "([0-9]+=[0-9]+),?" "--specialize;\\1;" options "${values}")
      set(variant "${folder}/${shader}_kernel_${number}.cpp")
      add_custom_command(
        OUTPUT "${variant}"
        COMMAND tandem-translate "${spirv}" ${options} --kernel "${variant}" --entry-symbol "${entry}_${number}"
        DEPENDS "${spirv}" tandem-translate
        COMMENT "SPIR-V to C++: ${source} with ${values}"
        VERBATIM)
      list(APPEND kernel_sources "${variant}")
      string(APPEND entry_declarations "extern \"C\" const tandem::kernel::KernelInfo* ${entry}_${number}();\n")
      string(APPEND kernel_entries "      {${shader}(), ${entry}_${number}, specialization_${number}},\n")
    endforeach()
  endforeach()

  file(CONFIGURE OUTPUT "${folder}/include/${name}/spirv.hpp" @ONLY CONTENT [[
#pragma once

#include <cstdint>
#include <span>

/// The SPIR-V of each shader.
namespace tandem::@name@ {

@word_declarations@
}  // namespace tandem::@name@
]])
  file(CONFIGURE OUTPUT "${folder}/include/${name}/kernels.hpp" @ONLY CONTENT [[
#pragma once

#include <span>

#include "rhi_cpu/cache/precompiled_kernel.hpp"

namespace tandem::@name@ {

/// The shaders of "@name@/spirv.hpp" as kernels of the CPU device.
std::span<const cpu::PrecompiledKernel> kernels();

}  // namespace tandem::@name@
]])
  file(CONFIGURE OUTPUT "${folder}/kernels.cpp" @ONLY CONTENT [[
#include "@name@/kernels.hpp"

#include "@name@/spirv.hpp"

@entry_declarations@
namespace tandem::@name@ {

std::span<const cpu::PrecompiledKernel> kernels() {
@specialization_values@  static const cpu::PrecompiledKernel all[] = {
@kernel_entries@  };
  return all;
}

}  // namespace tandem::@name@
]])

  tandem_library(${name} ${words_sources})
  target_include_directories(tandem_${name} PUBLIC $<BUILD_INTERFACE:${folder}/include>)
  tandem_library(${name}_kernels "${folder}/kernels.cpp" ${kernel_sources})
  target_link_libraries(tandem_${name}_kernels PUBLIC tandem_${name})
  target_link_libraries(tandem_${name}_kernels PRIVATE glm::glm)
  # Debug information changes no code, and lets a debugger step through the GLSL. Values of its variables are in a debug build only: for
  # a large shader they take the compiler as long as everything else.
  target_compile_options(tandem_${name}_kernels PRIVATE ${TANDEM_KERNEL_OPTIONS} $<IF:$<CONFIG:Debug>,-g;-O0,-g1>)
  list(LENGTH kernel_sources kernel_count)
  if(kernel_count GREATER 5)
    tandem_precompile_headers(tandem_${name}_kernels <rhi_cpu/kernel/kernel.hpp>)
  endif()
endfunction()
