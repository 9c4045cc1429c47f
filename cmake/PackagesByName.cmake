# SPDX-License-Identifier: BSD-3-Clause
# Packages without a CMake package worth using. Installed beside the program's own, so that what is
# exported names targets and no paths of the machine that built it.

# `find_package(PCL)` pulls VTK in through `io` and costs seconds at configure time; of PCL the point
# types and the file formats are used, so the libraries are found by name.
foreach(minor RANGE 12 29)  # a folder for each version, of which one is installed
  list(APPEND pcl_folders pcl-1.${minor})
endforeach()
find_path(PCL_INCLUDE_DIR pcl/point_types.h PATH_SUFFIXES ${pcl_folders} REQUIRED)
foreach(component common io)
  if(NOT TARGET pcl_${component}_only)
    find_library(PCL_${component}_LIBRARY pcl_${component} REQUIRED)
    add_library(pcl_${component}_only INTERFACE IMPORTED)
    target_include_directories(pcl_${component}_only SYSTEM INTERFACE ${PCL_INCLUDE_DIR})
    target_link_libraries(pcl_${component}_only INTERFACE ${PCL_${component}_LIBRARY} Eigen3::Eigen)
  endif()
endforeach()

foreach(library deflate lz4 zstd)
  if(NOT TARGET ${library}_only)
    string(TOUPPER ${library} name)
    find_library(${name}_LIBRARY ${library} REQUIRED)
    add_library(${library}_only INTERFACE IMPORTED)
    target_link_libraries(${library}_only INTERFACE ${${name}_LIBRARY})
  endif()
endforeach()
