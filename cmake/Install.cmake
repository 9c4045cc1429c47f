# SPDX-License-Identifier: BSD-3-Clause
# What `cmake --install` puts where, and the Debian packages that `cpack` makes of it: the program in
# one, the library with its headers and CMake package in the other.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/masked_mapper)
set(doc_dir ${CMAKE_INSTALL_DATAROOTDIR}/doc/masked-mapper)

# All rooms at once, for those who do not want to choose.
get_property(rooms GLOBAL PROPERTY masked_mapper_rooms)
add_library(masked_mapper_all INTERFACE)
target_link_libraries(masked_mapper_all INTERFACE ${rooms})
add_library(masked_mapper::masked_mapper ALIAS masked_mapper_all)
set_target_properties(masked_mapper_all PROPERTIES EXPORT_NAME masked_mapper)

# What is installed, without tests and examples.
add_custom_target(masked_mapper_installed)
add_dependencies(masked_mapper_installed masked_mapper ${rooms})

install(TARGETS masked_mapper RUNTIME COMPONENT program)
install(FILES config/default.yaml DESTINATION ${CMAKE_INSTALL_DATADIR}/masked_mapper
        COMPONENT program)
install(FILES LICENSE RENAME copyright DESTINATION ${doc_dir} COMPONENT program)
install(FILES README.md DESTINATION ${doc_dir} COMPONENT program)
install(DIRECTORY docs/ DESTINATION ${doc_dir} COMPONENT program FILES_MATCHING PATTERN "*.md"
        PATTERN images EXCLUDE)

install(TARGETS ${rooms} masked_mapper_all EXPORT masked_mapper_targets
        ARCHIVE COMPONENT development)
install(DIRECTORY include/masked_mapper DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        COMPONENT development)
install(DIRECTORY examples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libmasked-mapper-dev/examples
        COMPONENT development FILES_MATCHING PATTERN "*.cpp")
install(FILES LICENSE RENAME copyright
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libmasked-mapper-dev COMPONENT development)
install(EXPORT masked_mapper_targets NAMESPACE masked_mapper:: DESTINATION ${package_dir}
        COMPONENT development)
configure_package_config_file(cmake/masked_mapperConfig.cmake.in
  ${PROJECT_BINARY_DIR}/masked_mapperConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/masked_mapperConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/masked_mapperConfig.cmake
              ${PROJECT_BINARY_DIR}/masked_mapperConfigVersion.cmake
              cmake/PackagesByName.cmake
        DESTINATION ${package_dir} COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The masked_mapper authors <masked-mapper@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "offline mapper of multi-storey buildings from 2D-lidar logs")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME masked-mapper)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
    "Reads a robot's log (2D lidar, odometry) and writes a map of every floor.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libmasked-mapper-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# Archives have no libraries of their own to ask for: what masked_mapperConfig.cmake looks for.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libeigen3-dev, libpcl-dev, liboctomap-dev, libceres-dev, libyaml-cpp-dev, zlib1g-dev, \
libbz2-dev, libdeflate-dev, liblz4-dev, libzstd-dev, libsqlite3-dev, libfastcdr-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
    "Library, headers and CMake package, to build programs and masks of one's own.")
include(CPack)
