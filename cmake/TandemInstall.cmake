# `cmake --install`: a tree that may be moved anywhere. Libraries, headers, shaders, scenes, the program, and the files
# for find_package(Tandem).
include_guard()
include(CMakePackageConfigHelpers)

set(TANDEM_INSTALL_HEADERS "${CMAKE_INSTALL_INCLUDEDIR}/tandem")
set(TANDEM_INSTALL_PACKAGE "${CMAKE_INSTALL_LIBDIR}/cmake/Tandem")
set(TANDEM_INSTALL_DATA "${CMAKE_INSTALL_DATADIR}/tandem")

# The program links Tandem's libraries statically, and opens the module for pictures, which lies below them.
file(RELATIVE_PATH tandem_binaries_to_libraries "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}")
set_target_properties(tandem PROPERTIES INSTALL_RPATH "$ORIGIN/${tandem_binaries_to_libraries}/tandem")
install(TARGETS tandem RUNTIME)
if(TARGET tandem_image_openimageio)
  install(TARGETS tandem_image_openimageio LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/tandem")
endif()
if(TARGET tandem_view_window)
  install(TARGETS tandem_view_window LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/tandem")
endif()

# Every library of the project, except those that only its tests use.
get_property(tandem_libraries GLOBAL PROPERTY TANDEM_LIBRARIES)
set(tandem_installed_libraries)
foreach(library IN LISTS tandem_libraries)
  get_target_property(folder ${library} SOURCE_DIR)
  if(NOT folder MATCHES "^${PROJECT_SOURCE_DIR}/tests(/|$)")
    list(APPEND tandem_installed_libraries ${library})
    # Headers that the build makes, such as those of tandem_add_shaders.
    get_target_property(binary_folder ${library} BINARY_DIR)
    file(GLOB generated_headers LIST_DIRECTORIES true "${binary_folder}/*.generated/include")
    foreach(directory IN LISTS generated_headers)
      install(DIRECTORY "${directory}/" DESTINATION "${TANDEM_INSTALL_HEADERS}")
    endforeach()
  endif()
endforeach()
install(TARGETS ${tandem_installed_libraries} EXPORT TandemTargets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(EXPORT TandemTargets NAMESPACE Tandem:: DESTINATION "${TANDEM_INSTALL_PACKAGE}")

foreach(folder base rhi devices pathtracer compare conformance program rhi_cpu/kernel)
  cmake_path(GET folder PARENT_PATH parent)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/${folder}" DESTINATION "${TANDEM_INSTALL_HEADERS}/${parent}"
          FILES_MATCHING PATTERN "*.hpp")
endforeach()
# Of the backends only what makes a device; the rest of their headers is theirs.
foreach(header rhi_cpu/device.hpp rhi_cpu/cache/precompiled_kernel.hpp rhi_vulkan/device.hpp)
  cmake_path(GET header PARENT_PATH parent)
  install(FILES "${PROJECT_SOURCE_DIR}/${header}" DESTINATION "${TANDEM_INSTALL_HEADERS}/${parent}")
endforeach()

install(DIRECTORY "${PROJECT_SOURCE_DIR}/shaders" DESTINATION "${TANDEM_INSTALL_DATA}"
        FILES_MATCHING PATTERN "*.glsl" PATTERN "*.comp" PATTERN "*.rgen" PATTERN "*.rmiss" PATTERN "*.rchit" PATTERN "*.rahit" PATTERN "*.rint")
# Whole, but for what makes scenes and what needs files that do not ship; schemas lie where the scenes look for them.
install(DIRECTORY "${PROJECT_SOURCE_DIR}/scenes" DESTINATION "${TANDEM_INSTALL_DATA}"
        PATTERN generators EXCLUDE PATTERN thesis EXCLUDE PATTERN "*.py" EXCLUDE)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs/schema" DESTINATION "${TANDEM_INSTALL_DATA}/docs")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")

configure_package_config_file(
  "${CMAKE_CURRENT_LIST_DIR}/TandemConfig.cmake.in" "${PROJECT_BINARY_DIR}/TandemConfig.cmake"
  INSTALL_DESTINATION "${TANDEM_INSTALL_PACKAGE}"
  PATH_VARS TANDEM_INSTALL_DATA
  NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/TandemConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/TandemConfig.cmake" "${PROJECT_BINARY_DIR}/TandemConfigVersion.cmake"
        DESTINATION "${TANDEM_INSTALL_PACKAGE}")
