# SPDX-License-Identifier: BSD-3-Clause
# The one place that gives targets their flags, and the shape of rooms and their tests.
include(GNUInstallDirs)

# Flags of every target of ours. No -march, no -mavx: PCL and Eigen would disagree on alignment
# (docs/architecture.md).
function(masked_mapper_flags target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  if(MASKED_MAPPER_STRICT)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Werror)
  endif()
  if(MASKED_MAPPER_FUZZ)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link,address,undefined
                           -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  endif()
  # g++ 12 sees std::regex read what it did not write, once the sanitizers have rewritten it.
  if(MASKED_MAPPER_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${MASKED_MAPPER_SANITIZE}
                           -fno-sanitize-recover=all -fno-omit-frame-pointer -g1
                           $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    target_link_options(${target} PUBLIC -fsanitize=${MASKED_MAPPER_SANITIZE})
  endif()
  if(TARGET masked_mapper_precompiled AND NOT target MATCHES "^masked_mapper_precompiled")
    if(target MATCHES "_test$" AND TARGET masked_mapper_precompiled_for_tests)
      target_precompile_headers(${target} REUSE_FROM masked_mapper_precompiled_for_tests)
    else()
      target_precompile_headers(${target} REUSE_FROM masked_mapper_precompiled)
    endif()
  endif()
  if(MASKED_MAPPER_COVERAGE)
    target_compile_options(${target} PRIVATE --coverage)
    target_link_options(${target} PUBLIC --coverage)
  endif()
endfunction()

# masked_mapper_precompile(target [header...]): the dearest headers and the ones named, compiled once for
# all targets that come after. The linter reads every file without them, so that one that forgot an
# #include does not go unnoticed.
function(masked_mapper_precompile target)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp)
  file(GENERATE OUTPUT ${source} CONTENT "")
  add_library(${target} STATIC ${source})
  masked_mapper_flags(${target})
  target_link_libraries(${target} PRIVATE Eigen3::Eigen pcl_common_only)
  target_precompile_headers(${target} PRIVATE
    <Eigen/Core> <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <map> <memory> <optional>
    <pcl/point_cloud.h> <pcl/point_types.h> <regex> <set> <sstream> <string> <vector> ${ARGN})
endfunction()

# Everything compiled goes through ccache, where it is installed. What is compiled once for all targets
# (above) can be kept only so.
macro(masked_mapper_use_ccache)
  find_program(MASKED_MAPPER_CCACHE_PROGRAM ccache)
  mark_as_advanced(MASKED_MAPPER_CCACHE_PROGRAM)
  if(MASKED_MAPPER_CCACHE_PROGRAM)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
        CCACHE_SLOPPINESS=pch_defines,time_macros ${MASKED_MAPPER_CCACHE_PROGRAM})
  endif()
endmacro()

# masked_mapper_room(name PUBLIC lib... PRIVATE lib...): the library of the sources in src/<name>/.
# Its link list is the list of permitted arrows.
function(masked_mapper_room name)
  cmake_parse_arguments(ROOM "" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  set(target masked_mapper_${name})
  set(includes $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
               $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  if(sources)
    add_library(${target} STATIC ${sources})
    masked_mapper_flags(${target})
    target_include_directories(${target} PUBLIC ${includes})
    target_link_libraries(${target} PUBLIC ${ROOM_PUBLIC} PRIVATE ${ROOM_PRIVATE})
  else()  # a room of headers alone
    add_library(${target} INTERFACE)
    target_include_directories(${target} INTERFACE ${includes})
    target_link_libraries(${target} INTERFACE ${ROOM_PUBLIC} ${ROOM_PRIVATE})
  endif()
  add_library(masked_mapper::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY masked_mapper_rooms ${target})
endfunction()

# masked_mapper_room_test(name lib...): one GoogleTest binary of tests/<name>/*_test.cpp, with a temporary
# folder of its own. Tests see the headers that stand beside their sources, too: a room's own, which no
# other room includes.
function(masked_mapper_room_test name)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*_test.cpp)
  if(NOT sources)
    return()
  endif()
  set(target masked_mapper_${name}_test)
  add_executable(${target} ${sources} ${PROJECT_SOURCE_DIR}/tests/temporary_folder.cpp)
  masked_mapper_flags(${target})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE GTest::gtest_main ${ARGN})
  target_compile_definitions(${target} PRIVATE
    MASKED_MAPPER_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    MASKED_MAPPER_REAL_LOGS="${PROJECT_SOURCE_DIR}/../shared")
  gtest_discover_tests(${target} TEST_PREFIX ${name}/ PROPERTIES TIMEOUT 300)
endfunction()
