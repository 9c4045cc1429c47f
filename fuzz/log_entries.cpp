// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/entries.hpp"
#include "fuzz/input_file.hpp"
#include "log/ros_messages.hpp"
#include "log/ros_point_cloud.hpp"
#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/log/packed_cloud.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper::fuzz {
namespace {

void ReadToTheEnd(const std::string& path) {
  try {
    const std::unique_ptr<LogReader> reader = OpenLog(path, LogOptions{});
    while (reader->Next()) {
    }
    // Kept from being optimised away, and read once by the sanitizers.
    if (reader->Progress() < 0.0 || reader->Statistics().max_range < 0.0) std::abort();
  } catch (const InputError&) {
  }
}

}  // namespace

void CarmenLog(const std::uint8_t* data, std::size_t size) {
  const InputFile file(".log", data, size);
  ReadToTheEnd(file.path());
}

void RosBag1(const std::uint8_t* data, std::size_t size) {
  const InputFile file(".bag", data, size);
  ReadToTheEnd(file.path());
}

void RosBag2(const std::uint8_t* data, std::size_t size) {
  const InputFile file(".db3", data, size);
  ReadToTheEnd(file.path());
}

void Mcap(const std::uint8_t* data, std::size_t size) {
  const InputFile file(".mcap", data, size);
  ReadToTheEnd(file.path());
}

void RosMessages(const std::uint8_t* data, std::size_t size) {
  for (const MessageEncoding encoding : {MessageEncoding::kRos1, MessageEncoding::kCdr}) {
    ParseHeader(data, size, encoding);
    ParseLaserScan(data, size, encoding);
    ParseMultiEchoLaserScan(data, size, EchoChoice::kStrongest, encoding);
    if (!ParsePointCloud(data, size, encoding) && FaultOfPointCloud(data, size, encoding).empty()) {
      std::abort();
    }
    ParseOdometry(data, size, encoding);
    ParseTransforms(data, size, encoding);
    ParseImu(data, size, encoding);
    ParseFluidPressure(data, size, encoding);
  }
}

void PackedCloud(const std::uint8_t* data, std::size_t size) {
  const auto cloud = UnpackCloud({reinterpret_cast<const char*>(data), size});
  if (!cloud) return;
  for (const CloudPoint& point : cloud->points) {
    if (!point.position.allFinite()) std::abort();
  }
}

}  // namespace masked_mapper::fuzz
