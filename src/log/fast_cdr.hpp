// SPDX-License-Identifier: BSD-3-Clause
// Fast CDR, whose second version gave most of the first one's functions other names.
#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/exceptions/Exception.h>

#include <cstddef>

namespace masked_mapper {

using eprosima::fastcdr::Cdr;

#if __has_include(<fastcdr/CdrEncoding.hpp>)  // the second version

inline constexpr auto kDdsCdr = eprosima::fastcdr::DDS_CDR;
/// Bytes read or written so far.
inline std::size_t LengthOf(const Cdr& cdr) { return cdr.get_serialized_data_length(); }
inline const char* BytesOf(Cdr& cdr) { return cdr.get_buffer_pointer(); }
template <typename T>
void ReadArray(Cdr& cdr, T* values, std::size_t count) {
  cdr.deserialize_array(values, count);
}

#else

inline constexpr auto kDdsCdr = Cdr::DDS_CDR;
/// Bytes read or written so far.
inline std::size_t LengthOf(const Cdr& cdr) { return cdr.getSerializedDataLength(); }
inline const char* BytesOf(Cdr& cdr) { return cdr.getBufferPointer(); }
template <typename T>
void ReadArray(Cdr& cdr, T* values, std::size_t count) {
  cdr.deserializeArray(values, count);
}

#endif

}  // namespace masked_mapper
