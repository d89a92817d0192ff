# The language level, warnings, sanitizers and floating-point rules of every target.
include_guard()

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug or RelWithDebInfo" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(TANDEM_CCACHE ccache)
if(TANDEM_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Without these two, ccache leaves alone what is compiled with a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "${TANDEM_CCACHE}")
endif()

# Tandem's promise is results that agree to the last bit: no contraction into fma, no reassociation.
set(TANDEM_FLOATING_POINT_OPTIONS -ffp-contract=off -fno-fast-math)

if(TANDEM_SANITIZE)
  # Debian's glslang has no type information, which the check of virtual calls (vptr) needs of every class.
  add_compile_options(-fsanitize=address,undefined -fno-sanitize=vptr -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  # What the sanitizers insert makes g++ see uninitialised members of variants where there are none.
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  # AddressSanitizer opens libraries in the program's stead, so of the program's paths only those that hold for all it loads
  # (DT_RPATH instead of DT_RUNPATH) are searched for the module for pictures.
  add_link_options(-fsanitize=address,undefined LINKER:--disable-new-dtags)
endif()

# tandem_target(NAME): what every target of the project has in common. Headers are included as "folder/file.hpp".
function(tandem_target target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wno-sign-conversion ${TANDEM_FLOATING_POINT_OPTIONS})
  if(TANDEM_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# What most files of the project include: with tandem_precompile_headers, a third of the time to compile one is saved.
set(TANDEM_STANDARD_HEADERS <algorithm> <array> <cmath> <cstddef> <cstdint> <cstring> <filesystem> <functional> <limits> <map>
                            <memory> <optional> <span> <string> <string_view> <utility> <vector>)
set(TANDEM_COMMON_HEADERS ${TANDEM_STANDARD_HEADERS} <fmt/format.h> <glm/geometric.hpp> <glm/vec2.hpp> <glm/vec3.hpp> <glm/vec4.hpp>)

# tandem_precompile_headers(TARGET HEADER... | REUSE_FROM TARGET): target_precompile_headers, in a form that ccache can keep. Every
# file still includes what it uses: with CMAKE_DISABLE_PRECOMPILE_HEADERS, as in the preset clang, it compiles without.
function(tandem_precompile_headers target)
  if(ARGV1 STREQUAL REUSE_FROM)
    target_precompile_headers(${target} ${ARGN})
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
  if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    target_compile_options(
      ${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess> "$<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>")
  endif()
endfunction()

# tandem_optimize_little(TARGET): for what parses, prints and reports. The compiler takes half as long, and nobody notices.
function(tandem_optimize_little target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# tandem_library(NAME SOURCES...): a static library tandem_NAME with the alias Tandem::NAME.
function(tandem_library name)
  add_library(tandem_${name} STATIC ${ARGN})
  add_library(Tandem::${name} ALIAS tandem_${name})
  set_target_properties(tandem_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(
    tandem_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/tandem>)
  target_compile_features(tandem_${name} PUBLIC cxx_std_20)
  tandem_target(tandem_${name})
  set_property(GLOBAL APPEND PROPERTY TANDEM_LIBRARIES tandem_${name})
endfunction()
