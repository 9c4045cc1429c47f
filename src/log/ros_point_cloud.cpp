// SPDX-License-Identifier: BSD-3-Clause
#include "ros_point_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "ros_fields.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kMostFields = 256;
constexpr std::uint64_t kMostPoints = 10000000;
constexpr float kFarthest = 10000.0F;  // m; what is said to lie beyond is no return

// sensor_msgs/PointField
constexpr std::array<std::size_t, 9> kSizes = {0, 1, 1, 2, 2, 4, 4, 4, 8};

struct Field {
  std::string name;
  std::uint64_t offset = 0;
  std::uint8_t type = 0;
  std::uint32_t count = 0;

  std::size_t size() const { return type < kSizes.size() ? kSizes[type] : 0; }
};

struct CloudMessage {
  RosHeader header;
  std::uint64_t height = 0;
  std::uint64_t width = 0;
  std::vector<Field> fields;
  bool is_bigendian = false;
  std::uint64_t point_step = 0;
  std::uint64_t row_step = 0;
  ByteView data;
  bool is_complete = false;

  const Field* Find(const std::set<std::string>& names) const {
    const auto field = std::find_if(fields.begin(), fields.end(),
                                    [&names](const Field& f) { return names.count(f.name) > 0; });
    return field == fields.end() ? nullptr : &*field;
  }
};

template <typename Fields>
CloudMessage ReadMessage(Fields* fields) {
  CloudMessage message;
  message.header = fields->Header();
  message.height = fields->template Number<std::uint32_t>();
  message.width = fields->template Number<std::uint32_t>();
  constexpr std::size_t kLeastField = 4 + 4 + 1 + 4;  // without a name
  const std::size_t count = fields->Count(kLeastField);
  if (count > kMostFields) return message;
  for (std::size_t i = 0; i < count; ++i) {
    Field field;
    field.name = fields->String();
    field.offset = fields->template Number<std::uint32_t>();
    field.type = fields->template Number<std::uint8_t>();
    field.count = fields->template Number<std::uint32_t>();
    message.fields.push_back(std::move(field));
  }
  message.is_bigendian = fields->template Number<std::uint8_t>() != 0;
  message.point_step = fields->template Number<std::uint32_t>();
  message.row_step = fields->template Number<std::uint32_t>();
  message.data = fields->Bytes();
  fields->template Number<std::uint8_t>();  // is_dense: each point is looked at all the same
  message.is_complete = fields->good();
  // Of one row nobody needs the step, and some leave it out.
  if (message.height == 1) message.row_step = message.width * message.point_step;
  return message;
}

CloudMessage ReadMessage(const unsigned char* data, std::size_t size, MessageEncoding encoding) {
  if (encoding == MessageEncoding::kCdr) {
    CdrFields fields(data, size);
    return ReadMessage(&fields);
  }
  Ros1Fields fields(data, size);
  return ReadMessage(&fields);
}

/// Empty: all that is read of the message is inside it.
std::string FaultOf(const CloudMessage& cloud) {
  const auto text = [](std::uint64_t number) { return std::to_string(number); };
  if (!cloud.is_complete) return "is cut off, or says that it is longer than it is";
  // Both are less than 2^32: neither this product nor the next overflows.
  if (cloud.width * cloud.height > kMostPoints) {
    return "has " + text(cloud.height) + " x " + text(cloud.width) + " points, more than " +
           text(kMostPoints);
  }
  for (const char* axis : {"x", "y", "z"}) {
    const Field* field = cloud.Find({axis});
    if (field == nullptr) return std::string("has no field `") + axis + "`";
    if (field->size() == 0) {
      return std::string("has the field `") + axis + "` of type " + text(field->type) +
             ", expected 1 to 8";
    }
  }
  for (const Field& field : cloud.fields) {
    if (field.offset + field.size() <= cloud.point_step) continue;
    return "has the field `" + field.name + "` at byte " + text(field.offset) + " of points of " +
           text(cloud.point_step) + " bytes";
  }
  if (cloud.width * cloud.height == 0) return "";
  if (cloud.row_step < cloud.width * cloud.point_step) {
    return "has rows of " + text(cloud.row_step) + " bytes for " + text(cloud.width) +
           " points of " + text(cloud.point_step);
  }
  const std::uint64_t needed = (cloud.height - 1) * cloud.row_step + cloud.width * cloud.point_step;
  if (needed > cloud.data.size) {
    return "holds " + text(cloud.data.size) + " bytes of points where " + text(needed) +
           " were expected";
  }
  return "";
}

template <typename T, bool kSwapped>
double NumberAt(const unsigned char* bytes) {
  std::array<unsigned char, sizeof(T)> own{};
  std::memcpy(own.data(), bytes, sizeof(T));
  if constexpr (kSwapped) std::reverse(own.begin(), own.end());
  T value{};
  std::memcpy(&value, own.data(), sizeof(T));
  return static_cast<double>(value);
}

/// Where the points of a message lie that are returns.
using Places = std::vector<const unsigned char*>;

/// Neither no number nor at the origin, which stands for a ray that met nothing.
inline bool IsReturn(const Eigen::Vector3f& position) {
  const float x = std::abs(position.x());
  const float y = std::abs(position.y());
  const float z = std::abs(position.z());
  const bool is_near = x <= kFarthest && y <= kFarthest && z <= kFarthest;  // no number is not
  return is_near && x + y + z > 0.0F;
}

/// Numbers of one field, whatever their type: which it is, is asked once for all points.
class FieldReader {
 public:
  FieldReader(const Field& field, bool is_bigendian)
      : offset_(field.offset), type_(field.type), swapped_(is_bigendian) {}

  /// As nearly all clouds have their coordinates.
  bool IsFloat() const { return type_ == 7 && !swapped_; }
  float FloatAt(const unsigned char* point) const {
    float value = 0.0F;
    std::memcpy(&value, point + offset_, sizeof(value));
    return value;
  }

  /// `take(i, number)` of each point; of which type the field is, is asked once.
  template <typename Take>
  void Each(const Places& places, const Take& take) const {
    if (swapped_) {
      EachAs<true>(places, take);
    } else {
      EachAs<false>(places, take);
    }
  }

 private:
  template <bool kSwapped, typename Take>
  void EachAs(const Places& places, const Take& take) const {
    switch (type_) {
      case 1:
        return EachOf<std::int8_t, kSwapped>(places, take);
      case 2:
        return EachOf<std::uint8_t, kSwapped>(places, take);
      case 3:
        return EachOf<std::int16_t, kSwapped>(places, take);
      case 4:
        return EachOf<std::uint16_t, kSwapped>(places, take);
      case 5:
        return EachOf<std::int32_t, kSwapped>(places, take);
      case 6:
        return EachOf<std::uint32_t, kSwapped>(places, take);
      case 7:
        return EachOf<float, kSwapped>(places, take);
      default:
        return EachOf<double, kSwapped>(places, take);
    }
  }
  template <typename T, bool kSwapped, typename Take>
  void EachOf(const Places& places, const Take& take) const {
    for (std::size_t i = 0; i < places.size(); ++i) {
      take(i, NumberAt<T, kSwapped>(places[i] + offset_));
    }
  }

  std::uint64_t offset_;
  std::uint8_t type_;
  bool swapped_;
};

/// How times in whatever unit tell seconds after a stamp.
struct TimeUnit {
  double zero = 0.0;
  double unit = 0.0;  ///< s; 0: they tell nothing

  /// Of times, in seconds after `stamp`. A sweep lasts between 2 ms and 2 s, which only one of the
  /// units makes of it.
  static TimeUnit Of(double stamp, double first, double last) {
    constexpr double kShortest = 0.002;
    constexpr double kLongest = 2.0;
    for (const double unit : {1.0, 1e-3, 1e-6, 1e-9}) {
      const double span = (last - first) * unit;
      if (!(span > kShortest && span <= kLongest)) continue;
      // By the clock of the header, or counted from it, or by a clock that nobody knows.
      constexpr double kNear = 10.0;  // s
      if (std::abs(first * unit - stamp) < kNear) return {stamp / unit, unit};
      if (std::abs(first * unit) < kNear) return {0.0, unit};
      return {first, unit};
    }
    return {};
  }
};

/// Whether the times tell something; then the points have them.
bool ReadTimes(const FieldReader& reader, const Places& places, double stamp, CloudPoints* points) {
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  reader.Each(places, [&](std::size_t, double time) {
    if (!std::isfinite(time)) return;
    first = std::min(first, time);
    last = std::max(last, time);
  });
  const TimeUnit times = TimeUnit::Of(stamp, first, last);
  if (times.unit == 0.0) return false;
  reader.Each(places, [&](std::size_t i, double time) {
    if (!std::isfinite(time)) return;
    (*points)[i].time = static_cast<float>((time - times.zero) * times.unit);
  });
  return true;
}

std::optional<FieldReader> ReaderOf(const CloudMessage& message,
                                    const std::set<std::string>& names) {
  const Field* field = message.Find(names);
  if (field == nullptr || field->size() == 0) return std::nullopt;
  return FieldReader(*field, message.is_bigendian);
}

/// `take(place)` of each point.
template <typename Take>
void EachPlace(const CloudMessage& message, const Take& take) {
  // Rows without points may be claimed by the billion.
  const std::uint64_t rows = message.width == 0 ? 0 : message.height;
  for (std::uint64_t row = 0; row < rows; ++row) {
    const unsigned char* point = message.data.data + row * message.row_step;
    for (std::uint64_t i = 0; i < message.width; ++i, point += message.point_step) take(point);
  }
}

/// The returns with their positions; where they stand in the message.
Places ReadReturns(const CloudMessage& message, CloudPoints* points) {
  const std::array<FieldReader, 3> axes = {*ReaderOf(message, {"x"}), *ReaderOf(message, {"y"}),
                                           *ReaderOf(message, {"z"})};
  Places places;
  places.reserve(message.height * message.width);
  CloudPoint read;
  if (std::all_of(axes.begin(), axes.end(), [](const auto& axis) { return axis.IsFloat(); })) {
    points->reserve(message.height * message.width);
    EachPlace(message, [&](const unsigned char* point) {
      read.position = {axes[0].FloatAt(point), axes[1].FloatAt(point), axes[2].FloatAt(point)};
      if (!IsReturn(read.position)) return;
      points->push_back(read);
      places.push_back(point);
    });
    return places;
  }
  Places all;
  EachPlace(message, [&](const unsigned char* point) { all.push_back(point); });
  CloudPoints numbers(all.size());
  for (int axis = 0; axis < 3; ++axis) {
    axes[static_cast<std::size_t>(axis)].Each(all, [&](std::size_t i, double number) {
      numbers[i].position(axis) = static_cast<float>(number);
    });
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!IsReturn(numbers[i].position)) continue;
    points->push_back(numbers[i]);
    places.push_back(all[i]);
  }
  return places;
}

}  // namespace

std::optional<RosPointCloud> ParsePointCloud(const unsigned char* data, std::size_t size,
                                             MessageEncoding encoding) {
  const CloudMessage message = ReadMessage(data, size, encoding);
  if (!FaultOf(message).empty()) return std::nullopt;
  const auto intensity = ReaderOf(message, {"intensity", "reflectivity", "i"});
  const auto time =
      ReaderOf(message, {"t", "time", "timestamp", "time_stamp", "offset_time", "timeoffset"});
  RosPointCloud cloud;
  cloud.header = message.header;
  const Places places = ReadReturns(message, &cloud.points);
  if (intensity) {
    intensity->Each(places, [&cloud](std::size_t i, double value) {
      cloud.points[i].intensity = static_cast<float>(value);
    });
  }
  cloud.has_times = time && ReadTimes(*time, places, cloud.header.stamp, &cloud.points);
  return cloud;
}

std::string FaultOfPointCloud(const unsigned char* data, std::size_t size,
                              MessageEncoding encoding) {
  return FaultOf(ReadMessage(data, size, encoding));
}

}  // namespace masked_mapper
