# SPDX-License-Identifier: BSD-3-Clause
# Every outside package, found once. Which room may use which is said in src/CMakeLists.txt.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(ZLIB REQUIRED)
find_package(BZip2 REQUIRED)
find_package(Ceres 2.1 REQUIRED)
find_package(octomap 1.9 REQUIRED)
find_package(yaml-cpp 0.7 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(SQLite3 3.37 REQUIRED)
find_package(fastcdr REQUIRED)  # 1 or 2
include(${CMAKE_CURRENT_LIST_DIR}/PackagesByName.cmake)
