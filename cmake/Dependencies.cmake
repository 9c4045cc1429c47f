# SPDX-License-Identifier: BSD-3-Clause
# Every outside package, found once. Which room may use which is said in src/CMakeLists.txt.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(ZLIB REQUIRED)
find_package(BZip2 REQUIRED)
find_library(LZ4_LIBRARY lz4 REQUIRED)
find_package(Ceres 2.1 REQUIRED)
find_package(octomap 1.9 REQUIRED)
find_package(yaml-cpp 0.7 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(SQLite3 3.37 REQUIRED)

# `find_package(PCL)` pulls VTK in through `io` and costs seconds at configure time; of PCL the point
# types and the file formats are used, so the libraries are found by name.
find_path(PCL_INCLUDE_DIR pcl/point_types.h PATH_SUFFIXES pcl-1.13 pcl-1.14 pcl-1.12 REQUIRED)
foreach(component common io)
  find_library(PCL_${component}_LIBRARY pcl_${component} REQUIRED)
  add_library(pcl_${component}_only INTERFACE IMPORTED)
  target_include_directories(pcl_${component}_only SYSTEM INTERFACE ${PCL_INCLUDE_DIR})
  target_link_libraries(pcl_${component}_only INTERFACE ${PCL_${component}_LIBRARY} Eigen3::Eigen)
endforeach()
