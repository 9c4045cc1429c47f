// SPDX-License-Identifier: BSD-3-Clause
#include "kept_pass.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace masked_mapper {
namespace {

namespace fs = std::filesystem;

/// Appends values as they lie in memory; only this process reads them.
class Packer {
 public:
  template <typename... Values>
  void operator()(const Values&... values) {
    (Put(values), ...);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  template <typename T>
  void Put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  void Put(const Eigen::Vector3d& vector) { (*this)(vector.x(), vector.y(), vector.z()); }
  void Put(const std::string& text) { PutAll(text.data(), text.size()); }
  void Put(const std::vector<float>& values) { PutAll(values.data(), values.size()); }
  void Put(const std::optional<Pose2>& pose) { (*this)(pose.has_value(), pose.value_or(Pose2{})); }
  template <typename T>
  void PutAll(const T* values, std::size_t count) {
    Put(count);
    bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(T));
  }

  std::string bytes_;
};

/// Takes values in the order in which a Packer had them.
class Unpacking {
 public:
  explicit Unpacking(const std::string& bytes) : next_(bytes.data()) {}
  template <typename... Values>
  void operator()(Values&... values) {
    (Take(&values), ...);
  }
  const char* next() const { return next_; }

 private:
  template <typename T>
  void Take(T* value) {
    std::memcpy(static_cast<void*>(value), next_, sizeof(T));
    next_ += sizeof(T);
  }
  void Take(Eigen::Vector3d* vector) { (*this)(vector->x(), vector->y(), vector->z()); }
  void Take(std::string* text) { TakeAll(text); }
  void Take(std::vector<float>* values) { TakeAll(values); }
  void Take(std::optional<Pose2>* pose) {
    bool is_there = false;
    Pose2 value;
    (*this)(is_there, value);
    if (is_there) *pose = value;
  }
  template <typename Values>
  void TakeAll(Values* values) {
    std::size_t count = 0;
    Take(&count);
    values->resize(count);
    const std::size_t size = count * sizeof((*values)[0]);
    if (size > 0) std::memcpy(values->data(), next_, size);
    next_ += size;
  }

  const char* next_;
};

// Every member is named, so that one more of them does not compile before it is kept, too.
template <typename Reading, typename Archive>
void Each(Reading& reading, Archive* archive) {
  using Plain = std::remove_const_t<Reading>;
  if constexpr (std::is_same_v<Plain, LaserScan>) {
    auto& [stamp, log_stamp, T_robot_laser, first_angle, angle_step, max_range, ranges,
           T_odom_robot, beam_time] = reading;
    (*archive)(stamp, log_stamp, T_robot_laser, first_angle, angle_step, max_range, ranges,
               T_odom_robot, beam_time);
  } else {
    auto& [stamp, value] = reading;
    (*archive)(stamp, value);
  }
}

template <std::size_t I = 0>
Observation OfKind(std::size_t kind) {
  if constexpr (I + 1 < std::variant_size_v<Observation>) {
    if (kind != I) return OfKind<I + 1>(kind);
  }
  return Observation(std::in_place_index<I>);
}

}  // namespace

KeptPass::KeptPass(std::uint64_t most_bytes) : most_bytes_(most_bytes) {
  std::error_code no_folder;
  std::string path = (fs::temp_directory_path(no_folder) / "masked_mapper_pass_XXXXXX").string();
  const int descriptor = no_folder ? -1 : ::mkstemp(path.data());
  if (descriptor < 0) return;
  ::unlink(path.c_str());
  file_.reset(::fdopen(descriptor, "w+b"));
  if (!file_) ::close(descriptor);
}

void KeptPass::Add(const ObservationBatch& batch) {
  if (!file_) return;
  Packer packer;
  for (const Observation& observation : batch.observations) {
    packer(observation.index());
    std::visit([&packer](const auto& reading) { Each(reading, &packer); }, observation);
  }
  const std::size_t size = packer.bytes().size();
  if (size > most_bytes_ - end_ ||
      std::fwrite(packer.bytes().data(), 1, size, file_.get()) != size) {
    file_.reset();  // there is no room for it: the next pass makes it again
    return;
  }
  places_.push_back({end_, size, batch.progress});
  end_ += size;
  statistics_ = batch.statistics;
}

void KeptPass::AddClouds(std::vector<StampedCloud> clouds) {
  std::move(clouds.begin(), clouds.end(), std::back_inserter(clouds_));
}

void KeptPass::Finish() {
  const bool is_there = file_ && std::fflush(file_.get()) == 0;
  const std::lock_guard<std::mutex> lock(mutex_);
  has_ended_ = true;
  is_whole_ = is_there;
}

std::vector<StampedCloud> KeptPass::Clouds() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return has_ended_ ? clouds_ : std::vector<StampedCloud>();
}

bool KeptPass::IsWhole() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return is_whole_;
}

void KeptPass::Replay(const ReadAhead::Sink& sink) const {
  std::string bytes;
  for (const Place& place : places_) {
    bytes.resize(place.size);
    for (std::size_t read = 0; read < place.size;) {
      const ssize_t count = ::pread(::fileno(file_.get()), bytes.data() + read, place.size - read,
                                    static_cast<off_t>(place.offset + read));
      if (count <= 0) throw std::runtime_error("a temporary file cannot be read any more");
      read += static_cast<std::size_t>(count);
    }
    ObservationBatch batch;
    batch.statistics = statistics_;
    batch.progress = place.progress;
    Unpacking unpacking(bytes);
    for (const char* const end = bytes.data() + bytes.size(); unpacking.next() != end;) {
      std::size_t kind = 0;
      unpacking(kind);
      batch.observations.push_back(OfKind(kind));
      std::visit([&unpacking](auto& reading) { Each(reading, &unpacking); },
                 batch.observations.back());
    }
    if (!sink(std::move(batch))) return;
  }
}

}  // namespace masked_mapper
