// SPDX-License-Identifier: BSD-3-Clause
#include "relations.hpp"

#include <cmath>
#include <optional>
#include <string_view>

#include "error_statistics.hpp"
#include "masked_mapper/text/input_error.hpp"
#include "number_lines.hpp"

namespace masked_mapper {

std::vector<Relation> ReadRelations(const std::string& path) {
  std::vector<Relation> relations;
  ForEachLine(path, [&](std::string_view text, const FileLine& line) {
    const std::vector<std::string_view> words = WordsOf(text);
    if (words.empty() || words.front().front() == '#') return;
    if (words.size() != 8) {
      line.Fail("expected `t1 t2 x y z roll pitch yaw`, found " + std::to_string(words.size()) +
                " words");
    }
    std::vector<double> v;
    for (const std::string_view word : words) v.push_back(NumberIn(word, line));
    relations.push_back({v[0], v[1], {v[2], v[3], v[7]}});
  });
  if (relations.empty()) throw InputError(path + ": holds no relation");
  return relations;
}

RelationsError CompareWithRelations(const std::vector<StampedPose>& trajectory,
                                    const std::vector<Relation>& relations) {
  std::vector<double> translations;
  std::vector<double> rotations_deg;
  for (const Relation& relation : relations) {
    const std::optional<StampedPose> a = PoseAt(trajectory, relation.stamp_a);
    const std::optional<StampedPose> b = PoseAt(trajectory, relation.stamp_b);
    if (!a || !b) continue;
    const Pose2 left = Between(relation.T_a_b, Between(a->T_world_robot, b->T_world_robot));
    translations.push_back(std::hypot(left.x, left.y));
    rotations_deg.push_back(std::abs(RadToDeg(left.theta)));
  }
  return {relations.size(), translations.size(), StatisticsOf(translations),
          StatisticsOf(rotations_deg)};
}

}  // namespace masked_mapper
