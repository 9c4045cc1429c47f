// SPDX-License-Identifier: BSD-3-Clause
// Mending a finished map by hand: a few lines of YAML, after which the graph is solved again. What
// was measured is not mapped again.
//
//   - add_closure: {from: 81.5, to: 12.25, transform: [0.1, -0.4, 178.0], sigma: [0.05, 0.5]}
//   - add_closure: {from: 81.5, to: 12.25, guess: [0.0, 0.0, 180.0]}
//   - forbid_closure: {from: 90.0, to: 14.0}
//   - name_floor: {floor: "1", name: cellar}
//   - pin_elevation: {floor: cellar, elevation_m: -3.2}
//   - same_floor: {floor: "2", as: "0"}
//   - places: {dock: ["0", 1.5, -2.0], printer: ["1", 4.0, 7.5]}
//   - keep_out: {floor: "0", area: [[1, 1], [3, 1], [3, 2]]}
//   - erase: {floor: "0", area: [[1, 1], [3, 1], [3, 2]]}
//   - anchor: {floor: "0", at: [1.5, -2.0], is: [120.0, 80.5]}
#pragma once

#include <string>

#include "masked_mapper/loop_closure/loop_closure_options.hpp"
#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// Changes a finished map as the file says, in its order, solves it again and bends the trajectory
/// anew; each edit leaves a line among the warnings. Stamps are those of the log, in seconds, a
/// scan within half a second of them is meant; poses are [x, y, theta] of `to` in the frame of
/// `from`, in metres and degrees. Throws InputError that names file and line, and leaves the map as
/// it was.
void ApplyEdits(const std::string& path, const LoopClosureOptions& options, BuildingMap& map);

/// The same from text; `name` stands for the file in messages.
void ApplyEditsText(const std::string& name, const std::string& text,
                    const LoopClosureOptions& options, BuildingMap& map);

}  // namespace masked_mapper
