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
foreach(file share/tandem/scenes/cornell_box.obj share/tandem/scenes/cornell_box.mtl share/tandem/shaders/path_trace.comp)
  if(NOT EXISTS "${moved}/${file}")
    message(FATAL_ERROR "${file} is not installed")
  endif()
endforeach()

set(sanitizers)
if(SANITIZE)
  set(sanitizers "-DCMAKE_CXX_FLAGS=-fsanitize=address,undefined")
endif()
run("${CMAKE_COMMAND}" -S "${EXAMPLE}" -B "${WORK_FOLDER}/example" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${moved}"
    "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_BUILD_TYPE=${CONFIGURATION}" ${sanitizers})
run("${CMAKE_COMMAND}" --build "${WORK_FOLDER}/example" --config "${CONFIGURATION}")
find_program(example NAMES example PATHS "${WORK_FOLDER}/example" "${WORK_FOLDER}/example/${CONFIGURATION}" NO_DEFAULT_PATH REQUIRED)
run("${example}" "${moved}/share/tandem/scenes/cornell_box.obj")
if(NOT output MATCHES "agree")
  message(FATAL_ERROR "the example printed: ${output}")
endif()

# A component that does not exist is an error that names it.
execute_process(
  COMMAND "${CMAKE_COMMAND}" -S "${EXAMPLE}" -B "${WORK_FOLDER}/no_component" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${moved}"
          "-DCMAKE_CXX_COMPILER=${COMPILER}" -DEXTRA_COMPONENT=teapot
  RESULT_VARIABLE result
  OUTPUT_VARIABLE output
  ERROR_VARIABLE output)
if(result EQUAL 0 OR NOT output MATCHES "no component 'teapot'")
  message(FATAL_ERROR "find_package(Tandem COMPONENTS teapot) gave ${result}: ${output}")
endif()
file(REMOVE_RECURSE "${WORK_FOLDER}")
