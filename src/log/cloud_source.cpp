// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/log/cloud_source.hpp"

#include <algorithm>
#include <utility>

#include "bag_ahead.hpp"
#include "bag_look.hpp"
#include "bag_plan.hpp"
#include "bag_sequence.hpp"
#include "cloud_scanner.hpp"
#include "masked_mapper/log/log_source.hpp"
#include "masked_mapper/log/run_ahead.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "open_bag.hpp"

namespace masked_mapper {
namespace {

std::unique_ptr<RosBag> Opened(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    if (!IsBag(path)) throw InputError(path + ": is no bag, and only bags hold clouds");
  }
  if (paths.size() == 1) return OpenBag(paths.front());
  return std::make_unique<BagSequence>(paths, BagSequence::Order::kAsGiven);
}

}  // namespace

class CloudSource::Impl {
 public:
  Impl(const std::vector<std::string>& paths, const LogOptions& options)
      : options_(options), bag_(Opened(paths)) {
    if (!bag_->IsIndexed()) {
      while (bag_->Next()) {
      }  // the connections are wherever they are
      bag_->Rewind();
    }
    const std::string& path = paths.front();
    const BagPlan topics = ChooseTopics(path, bag_->Connections(), options_);
    const bool has_clouds =
        std::any_of(topics.topics.begin(), topics.topics.end(),
                    [](const BagTopic& topic) { return topic.kind == TopicKind::kCloud; });
    if (!has_clouds) throw InputError(path + ": its scans are not cut from clouds");
    plan_ = LookAtBag(path, options_, topics, bag_.get());
    bag_->Rewind();
    for (const Eigen::Isometry3d& T_robot_lidar : plan_.T_robot_lidar) {
      lidars_.emplace_back(options_, T_robot_lidar, static_cast<float>(plan_.max_range));
    }
    streams_ = std::make_unique<BagStreams>(plan_, *bag_);
    ahead_.emplace(bag_.get(), [streams = std::make_shared<BagStreams>(plan_, *bag_)](
                                   std::uint32_t id) { return streams->IsCloud(id); });
    clouds_.emplace(kCloudsAhead, [this](const auto& sink) { Produce(sink); });
  }

  std::optional<LevelledCloud> Next() {
    std::optional<Made> made = clouds_->Next();
    if (!made) {
      progress_ = 1.0;
      return std::nullopt;
    }
    progress_ = made->progress;
    return std::move(made->cloud);
  }

  double Progress() const { return progress_; }

 private:
  struct Made {
    LevelledCloud cloud;
    double progress = 0.0;
  };

  void Produce(const RunAhead<Made>::Sink& sink) {
    while (std::optional<LevelledCloud> cloud = Make()) {
      if (!sink({std::move(*cloud), ahead_->Progress()})) return;
    }
  }

  std::optional<LevelledCloud> Make() {
    while (const std::optional<BagMessage> message = ahead_->Next()) {
      const std::optional<std::size_t> stream = streams_->Find(message->connection);
      if (!stream) continue;
      auto parsed = ParseMessage(plan_.topics[*stream].kind, *message, options_);
      if (!parsed) continue;
      if (auto* cloud = std::get_if<RosPointCloud>(&*parsed)) {
        const double stamp = plan_.StampOf(*stream, message->time, cloud->header.stamp);
        return lidars_[plan_.topics[*stream].scanner].Level(std::move(*cloud), stamp, motion_);
      }
      NoteMotion(*stream, message->time, *parsed);
    }
    return std::nullopt;
  }

  void NoteMotion(std::size_t stream, double time, const RosMessage& message) {
    if (const auto* odometry = std::get_if<RosOdometry>(&message)) {
      motion_.Add(plan_.ReadingOf(stream, time, *odometry));
    } else if (const auto* imu = std::get_if<RosImu>(&message)) {
      motion_.Add(plan_.ReadingOf(stream, time, *imu));
    } else if (const auto* transforms = std::get_if<std::vector<RosTransform>>(&message)) {
      for (const RosTransform& transform : *transforms) {
        if (const auto reading = plan_.ReadingOf(stream, time, transform)) motion_.Add(*reading);
      }
    }
  }

  LogOptions options_;
  std::unique_ptr<RosBag> bag_;
  BagPlan plan_;
  std::unique_ptr<BagStreams> streams_;
  std::vector<CloudScanner> lidars_;
  RobotMotion motion_;
  std::optional<BagAhead> ahead_;
  static constexpr std::size_t kCloudsAhead = 8;
  double progress_ = 0.0;
  /// Made while whoever takes them is at work on the one before.
  std::optional<RunAhead<Made>> clouds_;
};

CloudSource::CloudSource(const std::vector<std::string>& paths, const LogOptions& options)
    : impl_(std::make_unique<Impl>(paths, options)) {}
CloudSource::~CloudSource() = default;

std::optional<LevelledCloud> CloudSource::Next() { return impl_->Next(); }
double CloudSource::Progress() const { return impl_->Progress(); }

}  // namespace masked_mapper
