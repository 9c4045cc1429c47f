// SPDX-License-Identifier: BSD-3-Clause
// ROS 2 bags as rosbag2 lays them out, written with SQLite and Fast CDR, for tests to read and
// spoil.
#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "log/fast_cdr.hpp"

namespace masked_mapper {

/// The bytes of a message whose fields `write` puts.
inline std::string CdrBytes(const std::function<void(Cdr&)>& write,
                            Cdr::Endianness endianness = Cdr::LITTLE_ENDIANNESS) {
  eprosima::fastcdr::FastBuffer buffer;
  Cdr cdr(buffer, endianness, kDdsCdr);
  cdr.serialize_encapsulation();
  write(cdr);
  return {BytesOf(cdr), LengthOf(cdr)};
}

inline void PutHeader(Cdr& cdr, std::int32_t seconds, const std::string& frame) {
  cdr << seconds << std::uint32_t{500000000} << frame;
}

inline void PutTransform(Cdr& cdr, double x, double y, double z, double yaw) {
  cdr << x << y << z << 0.0 << 0.0 << std::sin(yaw / 2) << std::cos(yaw / 2);
}

inline std::string CdrScan(std::int32_t seconds, const std::vector<float>& ranges,
                           Cdr::Endianness endianness = Cdr::LITTLE_ENDIANNESS) {
  return CdrBytes(
      [&](Cdr& cdr) {
        PutHeader(cdr, seconds, "laser");
        for (const float value : {-1.0F, 1.0F, 0.5F, 0.0F, 0.0F, 0.1F, 30.0F}) cdr << value;
        cdr << ranges << std::vector<float>{};
      },
      endianness);
}

inline std::string CdrMultiEchoScan(std::int32_t seconds,
                                    const std::vector<std::vector<float>>& echoes,
                                    const std::vector<std::vector<float>>& intensities) {
  return CdrBytes([&](Cdr& cdr) {
    PutHeader(cdr, seconds, "laser");
    for (const float value : {-1.0F, 1.0F, 0.5F, 0.0F, 0.0F, 0.1F, 30.0F}) cdr << value;
    for (const auto* of_beams : {&echoes, &intensities}) {
      cdr << static_cast<std::uint32_t>(of_beams->size());
      for (const std::vector<float>& of_beam : *of_beams) cdr << of_beam;
    }
  });
}

inline std::string CdrOdometry(std::int32_t seconds, double x, double y, double yaw) {
  return CdrBytes([&](Cdr& cdr) {
    PutHeader(cdr, seconds, "odom");
    cdr << std::string("base_link");
    PutTransform(cdr, x, y, 0.0, yaw);
    for (int i = 0; i < 36 + 6 + 36; ++i) cdr << 0.0;  // covariance, twist and its covariance
  });
}

/// base_link -> laser, and base_link -> imu turned by 90 degrees.
inline std::string CdrMounts() {
  return CdrBytes([](Cdr& cdr) {
    cdr << std::uint32_t{2};
    PutHeader(cdr, 0, "base_link");
    cdr << std::string("laser");
    PutTransform(cdr, 0.2, 0.1, 0.3, 0.5);
    PutHeader(cdr, 0, "base_link");
    cdr << std::string("imu");
    PutTransform(cdr, 0.0, 0.0, 0.0, M_PI / 2);
  });
}

inline std::string CdrImu(std::int32_t seconds, double ax, double ay, double az) {
  return CdrBytes([&](Cdr& cdr) {
    PutHeader(cdr, seconds, "imu");
    for (int i = 0; i < 4 + 9 + 3 + 9; ++i) cdr << 7.0;  // orientation and angular velocity
    cdr << ax << ay << az;
    for (int i = 0; i < 9; ++i) cdr << 0.0;
  });
}

inline std::string CdrPressure(std::int32_t seconds, double pascal) {
  return CdrBytes([&](Cdr& cdr) {
    PutHeader(cdr, seconds, "barometer");
    cdr << pascal << 0.0;
  });
}

/// A .db3 file.
class Ros2BagWriter {
 public:
  explicit Ros2BagWriter(const std::string& path) {
    EXPECT_EQ(sqlite3_open(path.c_str(), &database_), SQLITE_OK);
    Run("PRAGMA synchronous = OFF");
    Run("PRAGMA page_size = 1024");
  }
  ~Ros2BagWriter() { sqlite3_close(database_); }
  Ros2BagWriter(const Ros2BagWriter&) = delete;
  Ros2BagWriter& operator=(const Ros2BagWriter&) = delete;

  void Run(const std::string& sql) {
    EXPECT_EQ(sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database_);
  }

  void AddTables() {
    Run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)");
    Run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
        "timestamp INTEGER NOT NULL, data BLOB NOT NULL)");
    Run("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
  }

  void AddTopic(int id, const std::string& name, const std::string& type,
                const std::string& format = "cdr") {
    Run("INSERT INTO topics VALUES(" + std::to_string(id) + ", '" + name + "', '" + type + "', '" +
        format + "', '')");
  }

  void AddMessage(int topic, double time, const std::string& data) {
    sqlite3_stmt* insert = nullptr;
    ASSERT_EQ(sqlite3_prepare_v2(database_,
                                 "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                                 -1, &insert, nullptr),
              SQLITE_OK);
    sqlite3_bind_int(insert, 1, topic);
    sqlite3_bind_int64(insert, 2, static_cast<std::int64_t>(time * 1e9));
    sqlite3_bind_blob(insert, 3, data.data(), static_cast<int>(data.size()), SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
    sqlite3_finalize(insert);
  }

 private:
  sqlite3* database_ = nullptr;
};

/// A short drive along x, 0.1 m per second: scans, odometry, mounts, acceleration and pressure.
inline void WriteDrive(const std::string& path, int first_second = 100, int seconds = 12) {
  Ros2BagWriter bag(path);
  bag.AddTables();
  bag.Run("BEGIN");
  bag.AddTopic(1, "/scan", "sensor_msgs/msg/LaserScan");
  bag.AddTopic(2, "/odom", "nav_msgs/msg/Odometry");
  bag.AddTopic(3, "/tf_static", "tf2_msgs/msg/TFMessage");
  bag.AddTopic(4, "/imu", "sensor_msgs/msg/Imu");
  bag.AddTopic(5, "/pressure", "sensor_msgs/msg/FluidPressure");
  bag.AddTopic(6, "/camera", "sensor_msgs/msg/Image");
  bag.AddMessage(3, first_second, CdrMounts());
  for (int second = first_second; second < first_second + seconds; ++second) {
    bag.AddMessage(2, second + 0.5, CdrOdometry(second, 0.1 * second, 2.0, 0.0));
    bag.AddMessage(1, second + 0.5, CdrScan(second, {1, 2, 3, 40, 5}));
    bag.AddMessage(4, second + 0.5, CdrImu(second, 1.0, 0.0, 9.81));
    bag.AddMessage(5, second + 0.5, CdrPressure(second, 101325.0 - second));
    bag.AddMessage(6, second + 0.5, "not looked at");
  }
  bag.Run("COMMIT");
}

}  // namespace masked_mapper
