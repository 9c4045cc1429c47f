// SPDX-License-Identifier: BSD-3-Clause
// A uniform grid over segments: ray casting and clearance in time that does not grow with the
// building.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "masked_mapper/simulation/building.hpp"

namespace masked_mapper {

/// Range at which the ray from `origin` along the unit vector `direction` meets a segment, when
/// that is beyond `min_range` (m). A ray along the segment meets nothing.
inline std::optional<double> RayRange(const Eigen::Vector2d& origin,
                                      const Eigen::Vector2d& direction, const Segment& segment,
                                      double min_range) {
  const double ex = segment.b.x() - segment.a.x();
  const double ey = segment.b.y() - segment.a.y();
  const double denominator = direction.x() * ey - direction.y() * ex;
  if (denominator == 0.0) return std::nullopt;
  const double ox = segment.a.x() - origin.x();
  const double oy = segment.a.y() - origin.y();
  const double inverse = 1.0 / denominator;
  const double along = (ox * direction.y() - oy * direction.x()) * inverse;
  if (!(along >= 0.0 && along <= 1.0)) return std::nullopt;
  const double range = (ox * ey - oy * ex) * inverse;
  if (!(range > min_range)) return std::nullopt;
  return range;
}

class SegmentIndex {
 public:
  struct Hit {
    double range = 0.0;  ///< m
    std::uint32_t segment = 0;
  };

  explicit SegmentIndex(std::vector<Segment> segments);

  const std::vector<Segment>& segments() const { return segments_; }

  /// The first segment that a ray meets between `min_range` and `max_range` (exclusive); of several
  /// at the same range the one of the lowest index.
  std::optional<Hit> Cast(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                          double min_range, double max_range) const;

  /// Distance from a point to the nearest segment, or `limit` when none is nearer.
  double Clearance(const Eigen::Vector2d& point, double limit) const;
  /// The same for a straight way; 0 when it crosses a segment.
  double Clearance(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double limit) const;

 private:
  std::size_t Column(double x) const;
  std::size_t Row(double y) const;
  /// Narrows [enter, leave] to the part of a ray that lies over the grid; whether there is any.
  bool ClipToGrid(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, double& enter,
                  double& leave) const;
  /// Takes a hit in the cell that is nearer than `best`; `found`, and what comes back: whether
  /// `best` is a hit at all.
  bool NearestInCell(std::size_t cell, const Eigen::Vector2d& origin,
                     const Eigen::Vector2d& direction, double min_range, bool found,
                     Hit& best) const;

  std::vector<Segment> segments_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  double cell_ = 1.0;  ///< m
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  std::vector<std::uint32_t> cell_begin_;  ///< into cell_segments_, one more than there are cells
  std::vector<std::uint32_t> cell_segments_;
};

}  // namespace masked_mapper
