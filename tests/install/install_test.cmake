# Run by CTest with cmake -P; see CMakeLists.txt for the variables.

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${result}): ${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${WORK_FOLDER}")
file(MAKE_DIRECTORY "${WORK_FOLDER}")
set(installed "${WORK_FOLDER}/installed")
set(moved "${WORK_FOLDER}/moved elsewhere")
run("${CMAKE_COMMAND}" --install "${BUILD_FOLDER}" --config "${CONFIGURATION}" --prefix "${installed}")
file(RENAME "${installed}" "${moved}")

# Nothing for CMake, and no header, may lead back to where the tree was built or installed.
file(GLOB_RECURSE texts "${moved}/*.cmake" "${moved}/*.hpp")
foreach(text IN LISTS texts)
  file(READ "${text}" content)
  foreach(folder "${installed}" "${BUILD_FOLDER}" "${SOURCE_FOLDER}")
    string(FIND "${content}" "${folder}" position)
    if(NOT position EQUAL -1)
      message(FATAL_ERROR "${text} names ${folder}")
    endif()
  endforeach()
endforeach()

run("${moved}/bin/tandem" devices)
if(NOT EXISTS "${moved}/share/tandem/shaders/path_trace.comp")
  message(FATAL_ERROR "the shaders are not installed")
endif()

# Every scene is installed, and a scene that needs other files (a model, a picture of the sky) finds them.
set(scenes "${moved}/share/tandem/scenes")
file(GLOB_RECURSE expected RELATIVE "${SOURCE_FOLDER}/scenes" "${SOURCE_FOLDER}/scenes/*")
list(FILTER expected EXCLUDE REGEX "^(generators|thesis)/|\\.py$")
file(GLOB_RECURSE found RELATIVE "${scenes}" "${scenes}/*")
if(NOT found STREQUAL expected)
  message(FATAL_ERROR "installed scenes: ${found}\nthose of the project: ${expected}")
endif()
set(picture "${WORK_FOLDER}/environment.png")
run("${moved}/bin/tandem" render "${scenes}/environment.json" --device cpu --size 32x24 --spp 1 -o "${picture}")
if(NOT EXISTS "${picture}")
  message(FATAL_ERROR "no picture of environment.json: ${output}")
endif()

set(sanitizers)
if(SANITIZE)
  set(sanitizers "-DCMAKE_CXX_FLAGS=-fsanitize=address,undefined -Wl,--disable-new-dtags")  # as cmake/TandemToolchain.cmake
endif()
run("${CMAKE_COMMAND}" -S "${EXAMPLES}" -B "${WORK_FOLDER}/examples" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${moved}"
    "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_BUILD_TYPE=${CONFIGURATION}" ${sanitizers})
run("${CMAKE_COMMAND}" --build "${WORK_FOLDER}/examples" --config "${CONFIGURATION}")
function(find_example name)
  find_program(example_${name} NAMES ${name} PATHS "${WORK_FOLDER}/examples" "${WORK_FOLDER}/examples/${CONFIGURATION}"
               NO_DEFAULT_PATH REQUIRED)
endfunction()
find_example(compare_devices)
run("${example_compare_devices}" "${scenes}/cornell_box.obj" "${WORK_FOLDER}/example.exr")
if(NOT output MATCHES "cpu against cpu-exact: agree" OR NOT EXISTS "${WORK_FOLDER}/example.exr")
  message(FATAL_ERROR "compare_devices printed: ${output}")
endif()
# The triangle is above the points (i + 0.5) / 16 at z = 0.25 up to x = 0.75: the first twelve.
find_example(your_shader)
foreach(device cpu cpu-exact)
  run("${example_your_shader}" "${EXAMPLES}/your_shader/shadow.comp" ${device})
  if(NOT output MATCHES "^111111111111[01]000\n$")
    message(FATAL_ERROR "your_shader on ${device} printed: ${output}")
  endif()
endforeach()

# Shaders from the command line: a compute shader, a ray tracing pipeline, and a job of two launches.
set(shaders "${EXAMPLES}/run_shader")
run("${moved}/bin/tandem" run "${shaders}/saxpy.comp" --buffer X=1,2,3 --buffer Y=10,20,30 --buffer Result=zeros:3
    --push 2,3 --size 3 --spec negate=true --device cpu,cpu-exact --compare --save "Result=${WORK_FOLDER}/result.txt")
file(READ "${WORK_FOLDER}/result.txt" result)
if(NOT output MATCHES "cpu against cpu-exact: agree" OR NOT result STREQUAL "8\n16\n24\n")
  message(FATAL_ERROR "saxpy.comp printed: ${output} and wrote: ${result}")
endif()
run("${moved}/bin/tandem" run "${shaders}/camera.rgen" "${shaders}/sky.rmiss" "${shaders}/depth.rchit" --scene
    "${scenes}/cornell_box.obj" --image picture=32x32 --push position=278,273,-800 --push field_of_view=0.35 --record
    hit:0=1,0.5,0.25 --size 32x32 --device cpu,cpu-exact --compare --ulp 64 --save "picture=${WORK_FOLDER}/depth.png")
if(NOT output MATCHES "cpu against cpu-exact: agree" OR NOT EXISTS "${WORK_FOLDER}/depth.png")
  message(FATAL_ERROR "camera.rgen printed: ${output}")
endif()
run("${moved}/bin/tandem" run --job "${shaders}/job.json" --device cpu,cpu-exact --compare --save
    "four=${WORK_FOLDER}/four.npy")
if(NOT output MATCHES "four +1000 of 1000 values bit-equal")
  message(FATAL_ERROR "job.json printed: ${output}")
endif()

# A program that renders nothing needs no packages for scenes and pictures, and one for the rhi alone no backend's.
function(check_components components)
  set(folder "${WORK_FOLDER}/only")
  file(REMOVE_RECURSE "${folder}")
  list(TRANSFORM components PREPEND "Tandem::" OUTPUT_VARIABLE targets)
  list(JOIN components " " components)
  list(JOIN targets " " targets)
  file(WRITE "${folder}/CMakeLists.txt"
       "cmake_minimum_required(VERSION 3.25)\nproject(Only LANGUAGES CXX)\n"
       "find_package(Tandem 0.1 REQUIRED COMPONENTS ${components})\n"
       "add_executable(only \"${EXAMPLES}/your_shader/main.cpp\")\ntarget_link_libraries(only PRIVATE ${targets})\n")
  set(disabled)
  foreach(package IN LISTS ARGN)
    list(APPEND disabled "-DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON")
  endforeach()
  run("${CMAKE_COMMAND}" -S "${folder}" -B "${folder}/build" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${moved}"
      "-DCMAKE_CXX_COMPILER=${COMPILER}" ${disabled})
endfunction()
set(scene_packages TinyGLTF tinyobjloader ZLIB tinyexr PNG)
check_components("devices;glsl;rhi" ${scene_packages})
check_components("devices" ${scene_packages} glslang nlohmann_json)
check_components("rhi" ${scene_packages} Vulkan TBB embree glslang spirv_cross_glsl nlohmann_json glm)

# A component that does not exist is an error that names it.
execute_process(
  COMMAND "${CMAKE_COMMAND}" -S "${EXAMPLES}" -B "${WORK_FOLDER}/no_component" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${moved}"
          "-DCMAKE_CXX_COMPILER=${COMPILER}" -DEXTRA_COMPONENT=teapot
  RESULT_VARIABLE result
  OUTPUT_VARIABLE output
  ERROR_VARIABLE output)
if(result EQUAL 0 OR NOT output MATCHES "no component 'teapot'")
  message(FATAL_ERROR "find_package(Tandem COMPONENTS teapot) gave ${result}: ${output}")
endif()
file(REMOVE_RECURSE "${WORK_FOLDER}")
