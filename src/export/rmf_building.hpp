// SPDX-License-Identifier: BSD-3-Clause
// A building as rmf_traffic_editor has it, and the graph that its tools make of it.
#pragma once

#include <string>

#include "squared_map.hpp"

namespace masked_mapper {

class RmfBuilding {
 public:
  RmfBuilding(const SquaredMap& squared, std::string name);

  /// Coordinates in pixels of the pictures, y down.
  std::string BuildingYaml() const;
  /// Coordinates in metres, y up, from the upper left corner of the pictures.
  std::string NavGraphYaml() const;
  /// What takes coordinates of the squared map to those of the graph.
  Eigen::Vector2d Shift() const { return {-left_, -top_}; }

 private:
  struct Vertex {
    Eigen::Vector2d at_in_squared = Eigen::Vector2d::Zero();
    std::string name;
    std::string lift;  ///< of whose cab it is the middle
  };
  /// Of one level: those with lanes first, then those of walls and the two of the measurement.
  struct Level {
    std::vector<Vertex> vertices;
    std::vector<std::pair<std::size_t, std::size_t>> lanes;
    std::vector<std::pair<std::size_t, std::size_t>> walls;
    std::pair<std::size_t, std::size_t> measurement;
  };

  Level LevelOf(FloorId floor) const;
  std::string LevelText(FloorId floor) const;
  std::string LiftText(std::size_t crossing) const;
  Eigen::Vector2d InPixels(const Eigen::Vector2d& at_in_squared) const;
  std::string Label(FloorId floor) const;

  const SquaredMap& squared_;
  std::string name_;
  std::vector<std::string> crossing_names_;
  double left_ = 0.0;  ///< m, in squared: of the pictures
  double top_ = 0.0;
  double bottom_ = 0.0;
  double right_ = 0.0;
};

}  // namespace masked_mapper
