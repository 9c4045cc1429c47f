// SPDX-License-Identifier: BSD-3-Clause
// A ROS 1 bag as a file of records, with a position that never leaves it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bag_record.hpp"
#include "regular_file.hpp"

namespace masked_mapper {

class RecordFile {
 public:
  /// Throws InputError, as all below: cannot be opened or read.
  RecordFile(const std::string& path, std::string shown_name);

  std::uint64_t size() const { return file_.size(); }
  std::uint64_t position() const { return position_; }
  std::uint64_t left() const { return file_.size() - position_; }

  /// The header of the record at the position, and the length of its data, whose first byte is then
  /// the position. False when there is none. The header's bytes stay until the next call.
  bool ReadHeader(RecordHeader* header, std::uint64_t* data_size);
  /// `count` is at most left().
  void Read(std::uint64_t count, std::vector<unsigned char>* bytes);
  /// False when the file ends before; the position is then its end.
  bool Skip(std::uint64_t count);
  void Seek(std::uint64_t position);

 private:
  bool ReadLength(std::uint64_t* length);

  RegularFile file_;
  std::uint64_t position_ = 0;
  std::vector<unsigned char> header_bytes_;
};

}  // namespace masked_mapper
