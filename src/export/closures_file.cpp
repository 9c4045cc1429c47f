// SPDX-License-Identifier: BSD-3-Clause
#include "closures_file.hpp"

#include "masked_mapper/text/number_text.hpp"
#include "output_file.hpp"

namespace masked_mapper {
namespace {

// A field with a comma, a quote or a line break in quotes (RFC 4180).
std::string Field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char character : text) {
    if (character == '"') quoted += '"';
    quoted += character;
  }
  return quoted + "\"";
}

}  // namespace

void WriteClosures(const std::vector<Closure>& closures, const PoseGraph& graph,
                   const std::filesystem::path& path) {
  std::string text = "t_a,t_b,floor,dx,dy,dtheta,score,maha,votes,state,reason\n";
  for (const Closure& closure : closures) {
    const Node& a = graph.node(closure.newer);
    const Node& b = graph.node(closure.older);
    const Pose2 T_a_b = Inverse(closure.T_older_newer.mean);
    text += ExactText(a.stamp) + "," + ExactText(b.stamp) + "," +
            Field(graph.floor(a.floor).label) + "," + FixedText(T_a_b.x, 6) + "," +
            FixedText(T_a_b.y, 6) + "," + FixedText(T_a_b.theta, 9) + "," +
            FixedText(closure.score, 6) + "," + FixedText(closure.mahalanobis, 6) + "," +
            std::to_string(closure.votes) + "," + Name(closure.state) + "," +
            Field(Name(closure.reason)) + "\n";
  }
  WriteFile(path, text);
}

}  // namespace masked_mapper
