// SPDX-License-Identifier: BSD-3-Clause
// ROS bags made by hand, byte for byte, so that tests can spoil them.
#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <utility>

namespace masked_mapper {

template <typename T>
std::string Raw(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

inline std::string WithLength(const std::string& bytes) {
  return Raw(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

inline std::string BagRecord(std::initializer_list<std::pair<std::string, std::string>> fields,
                             const std::string& data) {
  std::string header;
  for (const auto& [name, value] : fields) header += WithLength(name + "=" + value);
  return WithLength(header) + WithLength(data);
}

inline std::string Op(char op) { return std::string(1, op); }

inline std::string ConnectionRecord(std::uint32_t id, const std::string& topic,
                                    const std::string& type, const std::string& md5sum) {
  return BagRecord(
      {{"op", Op(7)}, {"conn", Raw(id)}, {"topic", topic}},
      WithLength("topic=" + topic) + WithLength("type=" + type) + WithLength("md5sum=" + md5sum));
}

inline std::string MessageRecord(std::uint32_t id, std::uint32_t seconds, const std::string& data) {
  return BagRecord(
      {{"op", Op(2)}, {"conn", Raw(id)}, {"time", Raw(seconds) + Raw(std::uint32_t{500000000})}},
      data);
}

inline std::string ChunkRecord(const std::string& records,
                               const std::string& compression = "none") {
  return BagRecord({{"op", Op(5)},
                    {"compression", compression},
                    {"size", Raw(static_cast<std::uint32_t>(records.size()))}},
                   records);
}

inline std::string BagHeaderRecord(std::uint64_t index, std::uint32_t connections,
                                   std::uint32_t chunks) {
  return BagRecord({{"op", Op(3)},
                    {"index_pos", Raw(index)},
                    {"conn_count", Raw(connections)},
                    {"chunk_count", Raw(chunks)}},
                   std::string(100, ' '));
}

inline std::string BagMagic() { return "#ROSBAG V2.0\n"; }

inline std::string RosHeaderBytes(std::uint32_t seconds, const std::string& frame) {
  return Raw(std::uint32_t{0}) + Raw(seconds) + Raw(std::uint32_t{0}) + WithLength(frame);
}

inline std::string LaserScanBytes(std::uint32_t seconds, std::uint32_t beams) {
  std::string bytes = RosHeaderBytes(seconds, "/laser");
  for (const float value :
       {-1.0F, 1.0F, 2.0F / static_cast<float>(beams), 0.0F, 0.0F, 0.1F, 30.0F}) {
    bytes += Raw(value);
  }
  bytes += Raw(beams);
  for (std::uint32_t i = 0; i < beams; ++i) bytes += Raw(1.0F + static_cast<float>(i));
  return bytes + Raw(std::uint32_t{0});
}

constexpr const char* kLaserScanMd5 = "90c7ef2dc6895d81024acba2ac42f369";

/// A bag of three chunks with `per_chunk` scans each, one per second.
inline std::string ScanBag(bool indexed, std::uint32_t per_chunk = 4) {
  const std::string connection =
      ConnectionRecord(7, "/scan", "sensor_msgs/LaserScan", kLaserScanMd5);
  const std::uint64_t header_size = BagMagic().size() + BagHeaderRecord(0, 0, 0).size();
  std::string body;
  std::string infos;
  for (std::uint32_t chunk = 0; chunk < 3; ++chunk) {
    std::string records = chunk == 0 ? connection : "";
    for (std::uint32_t i = 0; i < per_chunk; ++i) {
      const std::uint32_t seconds = 100 + chunk * per_chunk + i;
      records += MessageRecord(7, seconds, LaserScanBytes(seconds, 5));
    }
    infos += BagRecord({{"op", Op(6)}, {"chunk_pos", Raw(header_size + body.size())}}, "");
    body += ChunkRecord(records);
  }
  const std::uint64_t index = header_size + body.size();
  return BagMagic() + (indexed ? BagHeaderRecord(index, 1, 3) : BagHeaderRecord(0, 0, 0)) + body +
         (indexed ? connection + infos : "");
}

}  // namespace masked_mapper
