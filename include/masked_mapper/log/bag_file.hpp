// SPDX-License-Identifier: BSD-3-Clause
// The records of a ROS 1 bag, format 2.0, read forward chunk by chunk; neither an index nor an end
// is needed, so that a bag whose recording was cut gives what it has. Every length in the file is
// checked before it is believed. (librosbag_storage reads by the index, uses its offsets unchecked,
// and its messages are resized to whatever count the file states: not for files of unknown origin.
// The tests hold this reader against it.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace masked_mapper {

struct BagConnection {
  std::string topic;
  std::string type;  ///< "sensor_msgs/LaserScan"
  std::string md5sum;
};

struct BagMessage {
  std::uint32_t connection = 0;
  double time = 0.0;                    ///< s, when it was recorded
  const unsigned char* data = nullptr;  ///< serialised; valid until the next call
  std::size_t size = 0;
};

class BagFile {
 public:
  /// Whether a file begins as a bag of any version does. False also when it cannot be opened.
  static bool IsBag(const std::string& path);

  /// Throws InputError: cannot be opened, obsolete version, encrypted, no bag.
  explicit BagFile(const std::string& path);
  ~BagFile();

  /// The next message in the order of recording; its connection is known. Empty at the end.
  std::optional<BagMessage> Next();
  /// Back to the first message. What is known of connections stays.
  void Rewind();

  /// By id. Complete from the start when the bag was closed properly, else as far as it was read.
  const std::map<std::uint32_t, BagConnection>& Connections() const;
  /// Whether the bag was closed properly: it has its index where it says.
  bool IsIndexed() const;
  /// The recording was not closed properly, or the file ends before its records do.
  bool Truncated() const;
  /// Records and chunks skipped because they make no sense.
  std::uint64_t Damaged() const;
  /// Share of the file consumed, 0 to 1.
  double Progress() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace masked_mapper
