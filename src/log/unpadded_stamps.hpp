// SPDX-License-Identifier: BSD-3-Clause
// Stamps whose microseconds were written as a number of their own, without zeros in front: "12.5"
// then means 12.000005 s. Seen by what such a log never has (a fraction that begins with a zero)
// and by what goes wrong with it (stamps step back, and no longer do when they are read that way).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

namespace masked_mapper {

class UnpaddedStamps {
 public:
  /// The next stamp of the log as it was written, in the order of its lines, and as it is meant if
  /// the log is of that kind, both in s; a stream is one kind of reading.
  double Meant(double stamp, std::size_t stream);

  /// Whether what was added so far is of that kind.
  bool IsFound() const;
  /// Stamps that mean another time than they say.
  std::uint64_t mended() const { return mended_; }

 private:
  struct Stream {
    double written = 0.0;
    double meant = 0.0;
  };

  std::map<std::size_t, Stream> newest_;
  double last_ = 0.0;  ///< s, of the line before, as it is meant
  std::uint64_t with_fraction_ = 0;
  std::uint64_t padded_ = 0;  ///< fractions that begin with a zero
  std::uint64_t steps_back_ = 0;
  std::uint64_t steps_back_as_meant_ = 0;
  std::uint64_t mended_ = 0;
};

}  // namespace masked_mapper
