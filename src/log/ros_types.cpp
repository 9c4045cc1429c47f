// SPDX-License-Identifier: BSD-3-Clause
#include "ros_types.hpp"

#include <map>
#include <set>
#include <sstream>
#include <vector>

namespace masked_mapper {
namespace {

constexpr RosType kTypes[] = {
    {"sensor_msgs", "LaserScan", "90c7ef2dc6895d81024acba2ac42f369", TopicKind::kScan},
    {"sensor_msgs", "MultiEchoLaserScan", "6fefb0c6da89d7c8abe4b339f5c2f8fb",
     TopicKind::kMultiEcho},
    {"sensor_msgs", "PointCloud2", "1158d486dd51d683ce2f1be655c3c181", TopicKind::kCloud},
    {"nav_msgs", "Odometry", "cd5e73d190d741a2f92e81eda573aca7", TopicKind::kOdometry},
    {"tf2_msgs", "TFMessage", "94810edda583a504dfda3829e70d7eec", TopicKind::kTransforms},
    {"tf", "tfMessage", "94810edda583a504dfda3829e70d7eec", TopicKind::kTransforms},
    {"sensor_msgs", "Imu", "6a62c6daae103f4ff57a132d6f95cec2", TopicKind::kImu},
    {"sensor_msgs", "FluidPressure", "804dc5cea1c5306d6a2eb80b9833befe", TopicKind::kPressure},
};

/// The fields of what is written.
const std::map<std::string, std::string>& Fields() {
  static const std::map<std::string, std::string> fields = {
      {"sensor_msgs/LaserScan",
       "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
       "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
       "float32[] ranges\nfloat32[] intensities\n"},
      {"sensor_msgs/PointCloud2",
       "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
       "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
      {"sensor_msgs/PointField",
       "uint8 INT8    = 1\nuint8 UINT8   = 2\nuint8 INT16   = 3\nuint8 UINT16  = 4\n"
       "uint8 INT32   = 5\nuint8 UINT32  = 6\nuint8 FLOAT32 = 7\nuint8 FLOAT64 = 8\n"
       "string name\nuint32 offset\nuint8  datatype\nuint32 count\n"},
      {"nav_msgs/Odometry",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
       "geometry_msgs/TwistWithCovariance twist\n"},
      {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
      {"sensor_msgs/Imu",
       "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
       "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
       "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
       "float64[9] linear_acceleration_covariance\n"},
      {"sensor_msgs/FluidPressure",
       "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n"},
      {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
      {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
      {"geometry_msgs/Pose",
       "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
      {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
      {"geometry_msgs/TransformStamped",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
      {"geometry_msgs/Transform",
       "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
      {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
      {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
  };
  return fields;
}

std::string FieldsOf(const std::string& type, MessageEncoding encoding) {
  if (type != "std_msgs/Header") return Fields().at(type);
  return encoding == MessageEncoding::kCdr ? "builtin_interfaces/Time stamp\nstring frame_id\n"
                                           : "uint32 seq\ntime stamp\nstring frame_id\n";
}

}  // namespace

std::optional<TopicKind> KindOf(const BagConnection& connection) {
  for (const RosType& type : kTypes) {
    if (connection.type == type.Ros2Name() && connection.md5sum.empty()) return type.kind;
    // A ROS 1 bag always has the sum, what was made of it not always.
    if (connection.type == type.Ros1Name() &&
        (connection.md5sum == type.md5sum || connection.md5sum.empty())) {
      return type.kind;
    }
  }
  return std::nullopt;
}

const RosType& TypeOfKind(TopicKind kind) {
  const RosType* found = kTypes;
  while (found->kind != kind) ++found;
  return *found;
}

std::string DefinitionOf(const RosType& type, MessageEncoding encoding) {
  std::vector<std::string> types = {type.Ros1Name()};
  std::set<std::string> known = {type.Ros1Name()};
  std::string definition;
  for (std::size_t i = 0; i < types.size(); ++i) {
    const std::string fields = FieldsOf(types[i], encoding);
    if (i > 0) definition += std::string(80, '=') + "\nMSG: " + types[i] + "\n";
    definition += fields;
    std::istringstream words(fields);
    for (std::string of, name; words >> of >> name;) {
      const std::string element = of.substr(0, of.find('['));
      if (element.find('/') != std::string::npos && known.insert(element).second) {
        types.push_back(element);
      }
    }
  }
  return definition;
}

}  // namespace masked_mapper
