// SPDX-License-Identifier: BSD-3-Clause
// A bag as it is written, of whatever kind. All throw std::runtime_error when the file cannot be
// written.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "ros_messages.hpp"
#include "ros_types.hpp"

namespace masked_mapper {

class BagWriter {
 public:
  virtual ~BagWriter() = default;
  /// What messages are to be written in.
  virtual MessageEncoding Encoding() const = 0;
  /// The number by which the topic is written to.
  virtual std::uint16_t AddTopic(const std::string& name, const RosType& type) = 0;
  virtual void Write(std::uint16_t topic, std::uint64_t time_ns, std::string_view message) = 0;
  /// Writes the indexes, without which the bag is one that was cut.
  virtual void Close() = 0;
};

}  // namespace masked_mapper
