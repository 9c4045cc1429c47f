// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/scan_matching/local_map.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "cell_slots.hpp"

namespace masked_mapper {
namespace {

double Square(double value) { return value * value; }

/// m; outside every local map, and its square a number in single precision.
constexpr float kNowhere = 1e6F;

}  // namespace

class LocalMap::Impl {
 public:
  Impl(const LocalMapOptions& options, const Eigen::Vector2d& center_in_map);

  void Add(const FacedPoints& points_in_robot, const Pose2& T_map_robot);
  Alignment Align(const FacedPoints& points_in_robot, const Pose2& T_map_robot_guess,
                  const Eigen::Matrix3d& prior_information) const;
  Alignment AlignHeld(const FacedPoints& points_in_robot, const Pose2& T_map_robot_guess,
                      const Eigen::Matrix3d& prior_information) const;
  double Agreement(const FacedPoints& points_in_robot, const Pose2& T_map_robot,
                   double sigma_m) const;
  std::size_t scans() const { return scans_; }

  /// What is known of a cell's surroundings follows from its points.
  template <class Archive>
  void Serialize(Archive& archive) {
    std::vector<std::int32_t> cells = slots_.cells();
    std::vector<std::int32_t> moments_at;
    for (const Slot& slot : in_use_) {
      moments_at.insert(moments_at.end(), slot.moments.begin(), slot.moments.end());
    }
    archive(corner_, cells, moments_at, moments_, scans_, front_rad_);
    if constexpr (Archive::kReads) {
      const auto is_one = [&](std::int32_t at) {
        return at >= kNone && at < static_cast<std::int32_t>(moments_.size());
      };
      if (moments_at.size() != kSides * cells.size() ||
          !std::all_of(moments_at.begin(), moments_at.end(), is_one)) {
        archive.Refuse("a local map that does not hold together");
      }
      if (!slots_.Take(cells)) archive.Refuse("a local map with a cell outside, or one twice");
      in_use_.assign(cells.size(), {});
      for (std::size_t i = 0; i < moments_at.size(); ++i) {
        in_use_[i / kSides].moments[i % kSides] = moments_at[i];
      }
      known_.clear();
    }
  }

 private:
  static constexpr std::size_t kSides = 4;
  static constexpr std::int32_t kNone = -1;

  struct Moments {
    double count = 0.0;
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;  ///< sums, about the cell's center

    void operator+=(const Moments& other);

    template <class Archive>
    void Serialize(Archive& archive) {
      archive(count, x, y, xx, xy, yy);
    }
  };
  struct Distribution {
    float mean_x = 0.0F, mean_y = 0.0F;      ///< from corner_
    float normal_x = 0.0F, normal_y = 0.0F;  ///< direction of the smaller variance
    float small = 0.0F, large = 0.0F;        ///< variances, m^2
    float count = 0.0F;                      ///< of points
    bool is_line = false;
    bool is_known = false;
  };
  /// A cell in use: where what is known of it stands. Most have a face or two, and their neighbours
  /// no points of their own, so that places are given to those that are asked for.
  struct Slot {
    /// Of each side, in moments_.
    std::array<std::int32_t, kSides> moments = {kNone, kNone, kNone, kNone};
    /// Of the surroundings, in known_: of each side, and of all of them together.
    std::array<std::int32_t, kSides + 1> known = {kNone, kNone, kNone, kNone, kNone};
    std::uint8_t settled = 0;  ///< a bit for each of `known`: no point came since it was worked out
  };
  using Cell = CellSlots::Cell;
  /// Points four at a time, in single precision: about the robot and the corner of the map that is
  /// good to some micrometres.
  using Four = Eigen::Array4f;
  using FourCells = Eigen::Array4i;
  /// Four points as an alignment goes on, and what is known where they lie: most stay in their
  /// cells from one step to the next.
  struct Sight {
    Four x = Four::Constant(kNowhere), y = Four::Zero();  ///< of the points, in robot
    FourCells cell = FourCells::Constant(kNone);  ///< row by row; kNone: outside, or no point
    Four mean_x = Four::Zero(), mean_y = Four::Zero();
    Four normal_x = Four::Zero(), normal_y = Four::Zero();
    Four small = Four::Ones(), large = Four::Ones();
    Four is_known = Four::Zero();   ///< 1: the point counts
    Four is_spread = Four::Zero();  ///< 1: no line; it counts along the wall, too
    /// What the noise of a wall's direction tells of the way along it: a share of a line's weight
    /// across it, and of the weight along what is no line.
    Four noise_of_line = Four::Zero(), noise_of_spread = Four::Zero();
    std::array<std::uint8_t, 4> side = {};
  };
  /// What the points of a scan say of its pose.
  struct Sums {
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    Eigen::Matrix2d of_noise = Eigen::Matrix2d::Zero();  ///< of the hessian of (x, y)
    double inliers = 0.0;
  };

  Alignment Align(const FacedPoints& points_in_robot, const Pose2& T_map_robot_guess,
                  const Eigen::Matrix3d& prior_information, double guess_outlier_sigmas) const;
  bool FindCell(double x, double y, Cell* cell) const;
  std::size_t AddSlot(Cell cell);
  Moments& MomentsOf(std::int32_t& at);
  std::vector<std::uint8_t> SidesOf(const FacedPoints& points, double theta) const;
  std::vector<Sight> SightsOf(const FacedPoints& points, double theta) const;
  std::size_t MarkAround(Cell cell, std::size_t side);
  const Distribution& Seen(std::size_t slot, std::size_t side) const;
  const Distribution& Settled(std::size_t slot, std::size_t side) const;
  Moments SumAround(Cell cell, std::size_t first_side, std::size_t end_side) const;
  void Describe(const Moments& sum, Cell cell, Distribution& distribution) const;
  void Look(std::size_t lane, std::int32_t cell, Sight& sight) const;
  Sums SumOver(std::vector<Sight>& sights, const Pose2& T_map_robot, double sigma_m) const;

  LocalMapOptions options_;
  double cells_per_m_;
  double front_rad_ = 0.0;  ///< surfaces that face within 90 deg of it are in front
  Eigen::Vector2d corner_;  ///< of cell (0, 0), in map
  CellSlots slots_;
  mutable std::vector<Slot> in_use_;         ///< of each slot of slots_
  std::vector<Moments> moments_;             ///< in order of their first points
  mutable std::vector<Distribution> known_;  ///< worked out where it is looked at
  std::size_t scans_ = 0;
};

LocalMap::Impl::Impl(const LocalMapOptions& options, const Eigen::Vector2d& center_in_map)
    : options_(options),
      cells_per_m_(1.0 / options.cell_m),
      slots_(2 * static_cast<int>(std::ceil(options.reach_m / options.cell_m)) + 1) {
  corner_ = center_in_map.array() - 0.5 * slots_.width() * options.cell_m;
}

void LocalMap::Impl::Moments::operator+=(const Moments& other) {
  count += other.count;
  x += other.x;
  y += other.y;
  xx += other.xx;
  xy += other.xy;
  yy += other.yy;
}

// A margin of a window is left out, so that neighbours need no check of their own.
bool LocalMap::Impl::FindCell(double x, double y, Cell* cell) const {
  const double column = (x - corner_.x()) * cells_per_m_;
  const double row = (y - corner_.y()) * cells_per_m_;
  const double least = options_.window_cells;
  const double end = slots_.width() - options_.window_cells;
  if (!(column >= least && row >= least && column < end && row < end)) return false;
  *cell = {static_cast<int>(column), static_cast<int>(row)};
  return true;
}

std::size_t LocalMap::Impl::AddSlot(Cell cell) {
  const std::size_t slot = slots_.Use(cell);
  if (slot == in_use_.size()) in_use_.emplace_back();
  return slot;
}

LocalMap::Impl::Moments& LocalMap::Impl::MomentsOf(std::int32_t& at) {
  if (at == kNone) {
    at = static_cast<std::int32_t>(moments_.size());
    moments_.emplace_back();
  }
  return moments_[static_cast<std::size_t>(at)];
}

std::vector<std::uint8_t> LocalMap::Impl::SidesOf(const FacedPoints& points, double theta) const {
  const auto c = static_cast<float>(std::cos(front_rad_ - theta));
  const auto s = static_cast<float>(std::sin(front_rad_ - theta));
  std::vector<std::uint8_t> sides(points.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool ahead = c * points.normal_x[i] + s * points.normal_y[i] >= 0.0F;
    const bool left = c * points.normal_y[i] - s * points.normal_x[i] >= 0.0F;
    sides[i] = static_cast<std::uint8_t>((ahead ? 0 : 1) + (left ? 0 : 2));
  }
  return sides;
}

std::vector<LocalMap::Impl::Sight> LocalMap::Impl::SightsOf(const FacedPoints& points,
                                                            double theta) const {
  const std::vector<std::uint8_t> sides = SidesOf(points, theta);
  std::vector<Sight> sights((points.size() + 3) / 4);
  for (std::size_t i = 0; i < points.size(); ++i) {
    // Not a number compares false.
    if (!(std::abs(points.x[i]) < kNowhere && std::abs(points.y[i]) < kNowhere)) continue;
    Sight& sight = sights[i / 4];
    const auto lane = static_cast<Eigen::Index>(i % 4);
    sight.x[lane] = points.x[i];
    sight.y[lane] = points.y[i];
    sight.side[i % 4] = sides[i];
  }
  return sights;
}

void LocalMap::Impl::Add(const FacedPoints& points_in_robot, const Pose2& T_map_robot) {
  if (scans_ == 0) front_rad_ = FrontOf(points_in_robot, T_map_robot.theta);
  const std::vector<std::uint8_t> sides = SidesOf(points_in_robot, T_map_robot.theta);
  const double c = std::cos(T_map_robot.theta);
  const double s = std::sin(T_map_robot.theta);
  Cell cell;
  Cell marked;  // by the point before, and of its side
  std::size_t marked_side = kSides;
  std::size_t slot = 0;
  for (std::size_t i = 0; i < points_in_robot.size(); ++i) {
    const float px = points_in_robot.x[i];
    const float py = points_in_robot.y[i];
    const double x = T_map_robot.x + c * px - s * py;
    const double y = T_map_robot.y + s * px + c * py;
    if (!FindCell(x, y, &cell)) continue;
    if (cell.column != marked.column || cell.row != marked.row || sides[i] != marked_side) {
      slot = MarkAround(cell, sides[i]);
      marked = cell;
      marked_side = sides[i];
    }
    const double dx = x - (corner_.x() + (cell.column + 0.5) * options_.cell_m);
    const double dy = y - (corner_.y() + (cell.row + 0.5) * options_.cell_m);
    Moments& moments = MomentsOf(in_use_[slot].moments[sides[i]]);
    moments.count += 1.0;
    moments.x += dx;
    moments.y += dy;
    moments.xx += dx * dx;
    moments.xy += dx * dy;
    moments.yy += dy * dy;
  }
  ++scans_;
}

// Returns the slot of the cell itself.
std::size_t LocalMap::Impl::MarkAround(Cell cell, std::size_t side) {
  const int window = options_.window_cells;
  const auto kept = static_cast<std::uint8_t>(~((1U << side) | (1U << kSides)));
  for (int dy = -window; dy <= window; ++dy) {
    for (int dx = -window; dx <= window; ++dx) {
      in_use_[AddSlot({cell.column + dx, cell.row + dy})].settled &= kept;
    }
  }
  return static_cast<std::size_t>(slots_.SlotOf(cell));
}

/// The moments of sides, from one to the one before another, over the window around a cell, about
/// its center.
LocalMap::Impl::Moments LocalMap::Impl::SumAround(Cell cell, std::size_t first_side,
                                                  std::size_t end_side) const {
  const int window = options_.window_cells;
  Moments sum;
  for (int dy = -window; dy <= window; ++dy) {
    for (int dx = -window; dx <= window; ++dx) {
      const Cell neighbour{cell.column + dx, cell.row + dy};
      if (!slots_.Contains(neighbour)) continue;
      const std::int32_t slot = slots_.SlotOf(neighbour);
      if (slot < 0) continue;
      const Slot& in_use = in_use_[static_cast<std::size_t>(slot)];
      Moments m;
      for (std::size_t side = first_side; side < end_side; ++side) {
        const std::int32_t at = in_use.moments[side];
        if (at != kNone) m += moments_[static_cast<std::size_t>(at)];
      }
      if (m.count == 0.0) continue;
      const double ox = dx * options_.cell_m;
      const double oy = dy * options_.cell_m;
      sum.count += m.count;
      sum.x += m.x + m.count * ox;
      sum.y += m.y + m.count * oy;
      sum.xx += m.xx + 2.0 * ox * m.x + m.count * ox * ox;
      sum.xy += m.xy + ox * m.y + oy * m.x + m.count * ox * oy;
      sum.yy += m.yy + 2.0 * oy * m.y + m.count * oy * oy;
    }
  }
  return sum;
}

void LocalMap::Impl::Describe(const Moments& sum, Cell cell, Distribution& d) const {
  const double mx = sum.x / sum.count;
  const double my = sum.y / sum.count;
  d.mean_x = static_cast<float>((cell.column + 0.5) * options_.cell_m + mx);
  d.mean_y = static_cast<float>((cell.row + 0.5) * options_.cell_m + my);
  const double xx = sum.xx / sum.count - mx * mx;
  const double xy = sum.xy / sum.count - mx * my;
  const double yy = sum.yy / sum.count - my * my;
  const double mean = 0.5 * (xx + yy);
  const double spread = std::sqrt(Square(0.5 * (xx - yy)) + Square(xy));
  const double small = std::max(0.0, mean - spread);
  const double large = mean + spread;
  // Cosine and sine of twice the direction of the larger variance, and of its half.
  const double cosine = spread > 0.0 ? 0.5 * (xx - yy) / spread : 1.0;
  d.normal_x = static_cast<float>(-std::copysign(std::sqrt(std::max(0.0, 0.5 - 0.5 * cosine)), xy));
  d.normal_y = static_cast<float>(std::sqrt(std::max(0.0, 0.5 + 0.5 * cosine)));
  d.small = static_cast<float>(small);
  d.large = static_cast<float>(large);
  d.count = static_cast<float>(sum.count);
  // Three points at the least, and spread over more than one cell: else a line is a guess.
  d.is_line = sum.count >= 3.0 && small < options_.line_ratio * large &&
              large > Square(0.5 * options_.cell_m);
  d.is_known = sum.count >= 2.0;
}

const LocalMap::Impl::Distribution& LocalMap::Impl::Settled(std::size_t slot,
                                                            std::size_t side) const {
  static const Distribution kNothing;
  Slot& in_use = in_use_[slot];
  std::int32_t& at = in_use.known[side];
  if ((in_use.settled >> side & 1U) != 0) {
    return at == kNone ? kNothing : known_[static_cast<std::size_t>(at)];
  }
  in_use.settled |= static_cast<std::uint8_t>(1U << side);
  const Cell cell = slots_.CellOf(slot);
  const Moments sum = side < kSides ? SumAround(cell, side, side + 1) : SumAround(cell, 0, kSides);
  if (sum.count == 0.0) return kNothing;
  if (at == kNone) {
    at = static_cast<std::int32_t>(known_.size());
    known_.emplace_back();
  }
  Distribution& known = known_[static_cast<std::size_t>(at)];
  Describe(sum, cell, known);
  return known;
}

// The face that is seen, where it is known as a line; else all that is known of the place.
const LocalMap::Impl::Distribution& LocalMap::Impl::Seen(std::size_t slot, std::size_t side) const {
  const Distribution& face = Settled(slot, side);
  return face.is_line ? face : Settled(slot, kSides);
}

/// Takes up what is known of a cell.
void LocalMap::Impl::Look(std::size_t lane, std::int32_t cell, Sight& sight) const {
  const auto i = static_cast<Eigen::Index>(lane);
  sight.cell[i] = cell;
  sight.is_known[i] = 0.0F;
  if (cell == kNone) return;
  const std::int32_t slot = slots_.SlotOf({cell % slots_.width(), cell / slots_.width()});
  if (slot < 0) return;
  const Distribution& seen = Seen(static_cast<std::size_t>(slot), sight.side[lane]);
  if (!seen.is_known) return;
  sight.is_known[i] = 1.0F;
  sight.is_spread[i] = seen.is_line ? 0.0F : 1.0F;
  sight.mean_x[i] = seen.mean_x;
  sight.mean_y[i] = seen.mean_y;
  sight.normal_x[i] = seen.normal_x;
  sight.normal_y[i] = seen.normal_y;
  sight.small[i] = seen.small;
  sight.large[i] = seen.large;
  sight.noise_of_line[i] = seen.is_line ? seen.small / (seen.count * seen.large) : 0.0F;
  sight.noise_of_spread[i] = seen.is_line ? 0.0F : 1.0F / (seen.count - 1.0F);
}

// Of noise: a line through n points with variances s across and l along it is wrong in direction by
// s / (n l) rad^2; as much of a point's information lies along it. Where a place is no line, a wall
// that is seen from afar may be all that it is, and what two points seem to tell of the way along
// it is where beams happened to fall.
LocalMap::Impl::Sums LocalMap::Impl::SumOver(std::vector<Sight>& sights, const Pose2& T_map_robot,
                                             double sigma_m) const {
  Sums sums;
  const auto c = static_cast<float>(std::cos(T_map_robot.theta));
  const auto s = static_cast<float>(std::sin(T_map_robot.theta));
  const auto x = static_cast<float>(T_map_robot.x - corner_.x());
  const auto y = static_cast<float>(T_map_robot.y - corner_.y());
  if (!(std::abs(x) < kNowhere && std::abs(y) < kNowhere)) return sums;
  const auto per_m = static_cast<float>(cells_per_m_);
  const auto noise = static_cast<float>(Square(sigma_m));
  const auto outlier = static_cast<float>(1.0 / Square(options_.outlier_sigmas));
  const auto least = static_cast<float>(options_.window_cells);
  const auto end = static_cast<float>(slots_.width() - options_.window_cells);
  const auto width = static_cast<float>(slots_.width());
  Four inliers = Four::Zero();
  Four h00 = Four::Zero(), h01 = Four::Zero(), h02 = Four::Zero(), h11 = Four::Zero();
  Four h12 = Four::Zero(), h22 = Four::Zero();
  Four g0 = Four::Zero(), g1 = Four::Zero(), g2 = Four::Zero();
  Four n00 = Four::Zero(), n01 = Four::Zero(), n11 = Four::Zero();
  for (Sight& sight : sights) {
    const Four rx = c * sight.x - s * sight.y;
    const Four ry = s * sight.x + c * sight.y;
    const Four column = (rx + x) * per_m;
    const Four row = (ry + y) * per_m;
    const auto is_inside = column >= least && row >= least && column < end && row < end;
    const FourCells cell = is_inside.select(row.max(0.0F).min(width).cast<int>() * slots_.width() +
                                                column.max(0.0F).min(width).cast<int>(),
                                            FourCells::Constant(kNone));
    if ((cell != sight.cell).any()) {
      for (std::size_t lane = 0; lane < 4; ++lane) {
        const auto i = static_cast<Eigen::Index>(lane);
        if (cell[i] != sight.cell[i]) Look(lane, cell[i], sight);
      }
    }
    const Four& nx = sight.normal_x;
    const Four& ny = sight.normal_y;
    const Four ex = rx + (x - sight.mean_x);
    const Four ey = ry + (y - sight.mean_y);
    const Four across = nx * ex + ny * ey;
    const Four along = nx * ey - ny * ex;
    const Four w_across = 1.0F / (sight.small + noise);
    const Four w_along = sight.is_spread / (sight.large + noise);
    const Four chi2 = w_across * across.square() + w_along * along.square();
    const Four weight = sight.is_known / (1.0F + chi2 * outlier).square();
    inliers += weight;
    // d(point)/d(x, y, theta) = [1 0 -ry; 0 1 rx], projected on the normal and on the tangent.
    const Four turn_across = ny * rx - nx * ry;
    const Four turn_along = ny * ry + nx * rx;
    const Four wa = weight * w_across;
    const Four wb = weight * w_along;
    h00 += wa * nx * nx + wb * ny * ny;
    h01 += (wa - wb) * nx * ny;
    h02 += wa * nx * turn_across - wb * ny * turn_along;
    h11 += wa * ny * ny + wb * nx * nx;
    h12 += wa * ny * turn_across + wb * nx * turn_along;
    h22 += wa * turn_across.square() + wb * turn_along.square();
    g0 += wa * nx * across - wb * ny * along;
    g1 += wa * ny * across + wb * nx * along;
    g2 += wa * turn_across * across + wb * turn_along * along;
    const Four of_noise = wa * sight.noise_of_line + wb * sight.noise_of_spread;
    n00 += of_noise * ny * ny;
    n01 -= of_noise * nx * ny;
    n11 += of_noise * nx * nx;
  }
  const auto sum = [](const Four& four) { return static_cast<double>(four.sum()); };
  sums.hessian << sum(h00), sum(h01), sum(h02), sum(h01), sum(h11), sum(h12), sum(h02), sum(h12),
      sum(h22);
  sums.gradient << sum(g0), sum(g1), sum(g2);
  sums.of_noise << sum(n00), sum(n01), sum(n01), sum(n11);
  sums.inliers = sum(inliers);
  return sums;
}

double LocalMap::Impl::Agreement(const FacedPoints& points_in_robot, const Pose2& T_map_robot,
                                 double sigma_m) const {
  if (points_in_robot.empty()) return 0.0;
  std::vector<Sight> sights = SightsOf(points_in_robot, T_map_robot.theta);
  return SumOver(sights, T_map_robot, sigma_m).inliers /
         static_cast<double>(points_in_robot.size());
}

Alignment LocalMap::Impl::Align(const FacedPoints& points_in_robot, const Pose2& T_map_robot_guess,
                                const Eigen::Matrix3d& prior_information) const {
  return Align(points_in_robot, T_map_robot_guess, prior_information,
               options_.guess_outlier_sigmas);
}

Alignment LocalMap::Impl::AlignHeld(const FacedPoints& points_in_robot,
                                    const Pose2& T_map_robot_guess,
                                    const Eigen::Matrix3d& prior_information) const {
  return Align(points_in_robot, T_map_robot_guess, prior_information,
               std::numeric_limits<double>::infinity());
}

Alignment LocalMap::Impl::Align(const FacedPoints& points_in_robot, const Pose2& T_map_robot_guess,
                                const Eigen::Matrix3d& prior_information,
                                double guess_outlier_sigmas) const {
  Alignment result;
  result.T_map_robot = T_map_robot_guess;
  if (points_in_robot.empty()) return result;
  double sigma = options_.first_sigma_m;
  // A guess turns by less than what lies between the walls of a building and the border of sides.
  std::vector<Sight> sights = SightsOf(points_in_robot, T_map_robot_guess.theta);
  for (; result.iterations < options_.max_iterations; ++result.iterations) {
    Pose2& pose = result.T_map_robot;
    const Sums sums = SumOver(sights, pose, sigma);
    // The scan's own weight shrinks by the inflation, so that the prior is weighed against what the
    // scan really knows.
    const Eigen::Vector3d from_guess(pose.x - T_map_robot_guess.x, pose.y - T_map_robot_guess.y,
                                     WrapAngle(pose.theta - T_map_robot_guess.theta));
    // Wheels slip, and some logs even have their sign wrong: a guess that the points contradict by
    // many sigmas loses its say (Cauchy), while one that they say nothing against keeps it.
    const double guess_chi2 = from_guess.dot(prior_information * from_guess);
    const Eigen::Matrix3d prior =
        prior_information / (1.0 + guess_chi2 / Square(guess_outlier_sigmas));
    const Eigen::Matrix3d total = sums.hessian / options_.covariance_inflation + prior;
    const Eigen::LDLT<Eigen::Matrix3d> factor(total);
    if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 1e-9)) return result;
    const Eigen::Vector3d step =
        -factor.solve(sums.gradient / options_.covariance_inflation + prior * from_guess);
    pose = {pose.x + step.x(), pose.y + step.y(), WrapAngle(pose.theta + step.z())};
    const bool is_fine = sigma <= options_.point_sigma_m;
    if (is_fine && step.head<2>().norm() < 5e-4 && std::abs(step.z()) < 1e-4) {
      result.converged = true;
      break;
    }
    sigma = std::max(options_.point_sigma_m, 0.5 * sigma);
  }
  const Sums sums = SumOver(sights, result.T_map_robot, options_.point_sigma_m);
  result.inlier_share = sums.inliers / static_cast<double>(points_in_robot.size());
  result.information = sums.hessian / options_.covariance_inflation;
  result.information_of_noise = sums.of_noise / options_.covariance_inflation;
  return result;
}

LocalMap::LocalMap(const LocalMapOptions& options, const Eigen::Vector2d& center_in_map)
    : impl_(std::make_unique<Impl>(options, center_in_map)) {}
LocalMap::~LocalMap() = default;
LocalMap::LocalMap(LocalMap&&) noexcept = default;
LocalMap& LocalMap::operator=(LocalMap&&) noexcept = default;

void LocalMap::Add(const FacedPoints& points_in_robot, const Pose2& T_map_robot) {
  impl_->Add(points_in_robot, T_map_robot);
}

Alignment LocalMap::Align(const FacedPoints& points_in_robot, const Pose2& T_map_robot_guess,
                          const Eigen::Matrix3d& prior_information) const {
  return impl_->Align(points_in_robot, T_map_robot_guess, prior_information);
}

Alignment LocalMap::AlignHeld(const FacedPoints& points_in_robot, const Pose2& T_map_robot_guess,
                              const Eigen::Matrix3d& prior_information) const {
  return impl_->AlignHeld(points_in_robot, T_map_robot_guess, prior_information);
}

double LocalMap::Agreement(const FacedPoints& points_in_robot, const Pose2& T_map_robot,
                           double sigma_m) const {
  return impl_->Agreement(points_in_robot, T_map_robot, sigma_m);
}

std::size_t LocalMap::scans() const { return impl_->scans(); }

void LocalMap::Serialize(StateWriter& archive) { impl_->Serialize(archive); }
void LocalMap::Serialize(StateReader& archive) { impl_->Serialize(archive); }

}  // namespace masked_mapper
