// SPDX-License-Identifier: BSD-3-Clause
// The running state of objects as bytes, for a checkpoint that the same program reads on the same
// machine. A class says once what its state is, for both directions:
//
//   template <class Archive>
//   void Serialize(Archive& archive) { archive(a_, b_, c_); }
//
// What follows from the rest (caches) and what is given anew (options) is left out. Archive::kReads
// tells the directions apart, Archive::Refuse() ends the reading of a state that cannot be.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

/// The bytes are not the state of what is read.
class StateError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <class Archive>
void Serialize(Archive& archive, Pose2& pose) {
  archive(pose.x, pose.y, pose.theta);
}

template <class Archive>
void Serialize(Archive& archive, UncertainPose2& pose) {
  archive(pose.mean, pose.covariance);
  if (Archive::kReads && !IsCovariance(pose.covariance)) {
    Archive::Refuse("a state with a covariance that is none");
  }
}

template <class Archive>
void Serialize(Archive& archive, OdometryReading& reading) {
  archive(reading.stamp, reading.T_odom_robot);
}

template <class Archive, class Scalar, int kRows, int kColumns>
void Serialize(Archive& archive, Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
  static_assert(kRows > 0 && kColumns > 0);
  for (int i = 0; i < kRows * kColumns; ++i) archive(matrix.data()[i]);
}

template <class Archive, class First, class Second>
void Serialize(Archive& archive, std::pair<First, Second>& pair) {
  archive(pair.first, pair.second);
}

template <class Type>
constexpr bool kIsPlain = std::is_arithmetic_v<Type> || std::is_enum_v<Type>;

/// Calls the type's own Serialize, or the one beside it.
template <class Archive, class Type, class = void>
struct SerializeCall {
  static void Do(Archive& archive, Type& value) { Serialize(archive, value); }
};
template <class Archive, class Type>
struct SerializeCall<
    Archive, Type,
    std::void_t<decltype(std::declval<Type&>().Serialize(std::declval<Archive&>()))>> {
  static void Do(Archive& archive, Type& value) { value.Serialize(archive); }
};

class StateWriter {
 public:
  static constexpr bool kReads = false;

  template <class... Types>
  void operator()(Types&... values) {
    (Put(values), ...);
  }

  const std::string& bytes() const { return bytes_; }
  std::string Take() { return std::move(bytes_); }
  [[noreturn]] static void Refuse(const std::string& what) { throw StateError(what); }

 private:
  void PutBytes(const void* bytes, std::size_t size) {
    bytes_.append(static_cast<const char*>(bytes), size);
  }
  void PutSize(std::size_t size) {
    const auto wide = std::uint64_t{size};
    PutBytes(&wide, sizeof wide);
  }

  template <class Type>
  void Put(Type& value) {
    if constexpr (kIsPlain<Type>) {
      PutBytes(&value, sizeof value);
    } else {
      SerializeCall<StateWriter, Type>::Do(*this, value);
    }
  }
  void Put(std::string& text) {
    PutSize(text.size());
    PutBytes(text.data(), text.size());
  }
  template <class Type>
  void Put(std::vector<Type>& items) {
    PutSize(items.size());
    if constexpr (kIsPlain<Type>) {
      PutBytes(items.data(), items.size() * sizeof(Type));
    } else {
      for (Type& item : items) Put(item);
    }
  }
  template <class Type>
  void Put(std::deque<Type>& items) {
    PutSize(items.size());
    for (Type& item : items) Put(item);
  }
  template <class Key, class Value>
  void Put(std::map<Key, Value>& items) {
    PutSize(items.size());
    for (auto& [key, value] : items) {
      Key copy = key;
      Put(copy);
      Put(value);
    }
  }
  template <class Type>
  void Put(std::optional<Type>& value) {
    bool present = value.has_value();
    Put(present);
    if (present) Put(*value);
  }

  std::string bytes_;
};

class StateReader {
 public:
  static constexpr bool kReads = true;

  explicit StateReader(std::string_view bytes) : bytes_(bytes) {}

  /// Throws StateError, as all below, when the bytes end too early or cannot be such a state.
  template <class... Types>
  void operator()(Types&... values) {
    (Get(values), ...);
  }

  bool IsAtEnd() const { return bytes_.empty(); }
  /// To be called in the end.
  void RequireEnd() const {
    if (!bytes_.empty()) Refuse("a state that goes on");
  }
  [[noreturn]] static void Refuse(const std::string& what) { throw StateError(what); }

 private:
  void GetBytes(void* bytes, std::size_t size) {
    if (size > bytes_.size()) Refuse("a state that is cut off");
    if (size > 0) std::memcpy(bytes, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  /// Of items of at least `least` bytes each, of which there cannot be more than bytes are left.
  std::size_t GetSize(std::size_t least) {
    std::uint64_t size = 0;
    GetBytes(&size, sizeof size);
    if (size > bytes_.size() / least) Refuse("a state with more in it than it has bytes");
    return static_cast<std::size_t>(size);
  }

  template <class Type>
  void Get(Type& value) {
    if constexpr (std::is_same_v<Type, bool>) {
      std::uint8_t byte = 0;
      GetBytes(&byte, 1);
      if (byte > 1) Refuse("a state with a flag that is neither");
      value = byte == 1;
    } else if constexpr (kIsPlain<Type>) {
      GetBytes(&value, sizeof value);
    } else {
      SerializeCall<StateReader, Type>::Do(*this, value);
    }
  }
  void Get(std::string& text) {
    text.resize(GetSize(1));
    GetBytes(text.data(), text.size());
  }
  template <class Type>
  void Get(std::vector<Type>& items) {
    items.clear();
    if constexpr (kIsPlain<Type>) {
      items.resize(GetSize(sizeof(Type)));
      GetBytes(items.data(), items.size() * sizeof(Type));
    } else {
      // One after the other: an item that cannot be ends it before much is allocated.
      for (std::size_t left = GetSize(1); left > 0; --left) Get(items.emplace_back());
    }
  }
  template <class Type>
  void Get(std::deque<Type>& items) {
    items.clear();
    for (std::size_t left = GetSize(1); left > 0; --left) Get(items.emplace_back());
  }
  template <class Key, class Value>
  void Get(std::map<Key, Value>& items) {
    items.clear();
    for (std::size_t left = GetSize(1); left > 0; --left) {
      Key key{};
      Get(key);
      Get(items[key]);
    }
  }
  template <class Type>
  void Get(std::optional<Type>& value) {
    bool present = false;
    Get(present);
    value.reset();
    if (present) Get(value.emplace());
  }

  std::string_view bytes_;
};

}  // namespace masked_mapper
