// SPDX-License-Identifier: BSD-3-Clause
#include "space_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace masked_mapper {
namespace {

constexpr double kCeiling = 2.7;         // m, where storeys are not lower
constexpr double kBetweenStoreys = 0.3;  // m of concrete
constexpr double kDoorHeight = 2.05;     // m
constexpr std::array<double, 4> kFurniture = {0.74, 1.2, 1.9, 2.2};  // m
constexpr double kCell = 0.5;                                        // m

double CeilingOf(const Building& building, std::size_t floor) {
  if (floor + 1 >= building.floors.size()) return kCeiling;
  const double storey = building.floors[floor + 1].elevation - building.floors[floor].elevation;
  return std::min(kCeiling, std::max(storey - kBetweenStoreys, 1.0));
}

std::vector<Upright> UprightsOf(const std::vector<Segment>& segments, double ceiling) {
  std::vector<Upright> uprights;
  std::size_t piece = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    double high = ceiling;
    if (segment.surface == Surface::kDoor) high = std::min(kDoorHeight, ceiling);
    if (segment.surface == Surface::kFurniture) {
      // The sides of one piece stand together.
      const bool goes_on = i > 0 && segments[i - 1].surface == Surface::kFurniture &&
                           (segments[i - 1].b - segment.a).norm() < 1e-6;
      piece += goes_on ? 0 : 1;
      high = std::min(kFurniture[piece % kFurniture.size()], ceiling);
    }
    uprights.push_back({segment, 0.0, high});
  }
  return uprights;
}

void AddSides(const Overhead& block, std::vector<Upright>* uprights) {
  const double x = 0.5 * block.length;
  const double y = 0.5 * block.width;
  const Pose2& T = block.T_building_block;
  const std::array<Eigen::Vector2d, 4> corners{
      T * Eigen::Vector2d(-x, -y), T * Eigen::Vector2d(x, -y), T * Eigen::Vector2d(x, y),
      T * Eigen::Vector2d(-x, y)};
  for (std::size_t e = 0; e < 4; ++e) {
    uprights->push_back(
        {{corners[e], corners[(e + 1) % 4], Surface::kFurniture}, block.low, block.high});
  }
}

/// The leaves of cabs' doors, from a height up.
void AddCabDoors(const Building& building, std::size_t floor, double low, double high,
                 std::vector<Upright>* uprights) {
  for (const Elevator& elevator : building.elevators) {
    for (const Landing& landing : elevator.landings) {
      if (landing.floor != floor || !(high > low)) continue;
      for (Segment leaf : CabDoor(elevator, 0.0)) {
        leaf.surface = Surface::kWall;
        uprights->push_back({leaf, low, high});
      }
    }
  }
}

double OutsideOf(double value, double low, double high) {
  return std::max({low - value, value - high, 0.0});
}

}  // namespace

SpaceSurfaces SurfacesOf(const Building& building, std::size_t floor) {
  SpaceSurfaces surfaces;
  surfaces.ceiling = CeilingOf(building, floor);
  surfaces.standing = UprightsOf(StandingSegments(building, floor), surfaces.ceiling);
  AddCabDoors(building, floor, kCabDoorHeight, surfaces.ceiling, &surfaces.standing);
  for (Overhead block : building.floors[floor].overhead) {
    block.high = std::min(block.high, surfaces.ceiling);
    if (!(block.low < block.high)) continue;
    AddSides(block, &surfaces.standing);
    surfaces.overhead.push_back(block);
  }
  return surfaces;
}

TrueSurfaces::TrueSurfaces(const Building& building, std::size_t floor, double limit)
    : surfaces_(SurfacesOf(building, floor)), limit_(limit) {
  AddCabDoors(building, floor, 0.0, std::min(kCabDoorHeight, surfaces_.ceiling),
              &surfaces_.standing);
  Bounds bounds = BoundsOf(building.floors[floor]);
  for (const Upright& upright : surfaces_.standing) {  // cabs, too
    bounds.low = bounds.low.cwiseMin(upright.segment.a).cwiseMin(upright.segment.b);
    bounds.high = bounds.high.cwiseMax(upright.segment.a).cwiseMax(upright.segment.b);
  }
  low_ = bounds.low - Eigen::Vector2d::Constant(limit + kCell);
  const Eigen::Vector2d extent = bounds.high + Eigen::Vector2d::Constant(limit + kCell) - low_;
  columns_ = static_cast<std::size_t>(extent.x() / kCell) + 1;
  const auto rows = static_cast<std::size_t>(extent.y() / kCell) + 1;
  cells_.resize(columns_ * rows);
  const double reach = limit + kCell;
  for (std::size_t i = 0; i < surfaces_.standing.size(); ++i) {
    const Segment& segment = surfaces_.standing[i].segment;
    const Eigen::Vector2d first = (segment.a.cwiseMin(segment.b) - low_).array() - reach;
    const Eigen::Vector2d last = (segment.a.cwiseMax(segment.b) - low_).array() + reach;
    const auto index = [](double metres, std::size_t count) {
      return std::min(static_cast<std::size_t>(std::max(metres, 0.0) / kCell), count - 1);
    };
    for (std::size_t row = index(first.y(), rows); row <= index(last.y(), rows); ++row) {
      for (std::size_t column = index(first.x(), columns_); column <= index(last.x(), columns_);
           ++column) {
        const Eigen::Vector2d centre =
            low_ + kCell * Eigen::Vector2d(static_cast<double>(column) + 0.5,
                                           static_cast<double>(row) + 0.5);
        if (DistanceToSegment(centre, segment.a, segment.b) > reach) continue;
        cells_[row * columns_ + column].push_back(i);
      }
    }
  }
}

const std::vector<std::size_t>* TrueSurfaces::Near(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d cell = (point - low_) / kCell;
  if (!(cell.minCoeff() >= 0.0) || !(cell.x() < static_cast<double>(columns_))) return nullptr;
  const std::size_t index =
      static_cast<std::size_t>(cell.y()) * columns_ + static_cast<std::size_t>(cell.x());
  return index < cells_.size() ? &cells_[index] : nullptr;
}

double TrueSurfaces::Distance(const Eigen::Vector3d& point) const {
  const Eigen::Vector2d below = point.head<2>();
  double nearest = std::min({limit_, std::abs(point.z()), std::abs(point.z() - surfaces_.ceiling)});
  if (const std::vector<std::size_t>* near = Near(below)) {
    for (const std::size_t i : *near) {
      const Upright& upright = surfaces_.standing[i];
      const double aside = DistanceToSegment(below, upright.segment.a, upright.segment.b);
      nearest =
          std::min(nearest, std::hypot(aside, OutsideOf(point.z(), upright.low, upright.high)));
    }
  }
  for (const Overhead& block : surfaces_.overhead) {
    const Eigen::Vector2d in_block = Inverse(block.T_building_block) * below;
    const double x = std::max(std::abs(in_block.x()) - 0.5 * block.length, 0.0);
    const double y = std::max(std::abs(in_block.y()) - 0.5 * block.width, 0.0);
    if (!(x < limit_ && y < limit_)) continue;
    for (const double height : {block.low, block.high}) {
      nearest = std::min(nearest, std::hypot(x, y, point.z() - height));
    }
  }
  return nearest;
}

}  // namespace masked_mapper
