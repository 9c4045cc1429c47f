// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/export/closures_file.hpp"

#include <cassert>

#include "masked_mapper/export/output_file.hpp"
#include "masked_mapper/text/number_text.hpp"

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

std::string StateName(ClosureState state) {
  switch (state) {
    case ClosureState::kRejectedScore:
      return "rejected_score";
    case ClosureState::kHypothesis:
      return "hypothesis";
    case ClosureState::kValidated:
      return "validated";
    case ClosureState::kAuditedOut:
      return "audited_out";
  }
  assert(false);
  return "";
}

void WriteClosures(const std::vector<ClosureAttempt>& attempts, const PoseGraph& graph,
                   const std::filesystem::path& path) {
  std::string text = "t_a,t_b,floor,dx,dy,dtheta,score,maha,votes,state,reason\n";
  for (const ClosureAttempt& attempt : attempts) {
    const Node& a = graph.nodes().at(static_cast<std::size_t>(attempt.a));
    const Node& b = graph.nodes().at(static_cast<std::size_t>(attempt.b));
    const Pose2& T_a_b = attempt.T_a_b.mean;
    text += ExactText(a.stamp) + "," + ExactText(b.stamp) + "," +
            Field(graph.floors().at(static_cast<std::size_t>(a.floor)).label) + "," +
            FixedText(T_a_b.x, 6) + "," + FixedText(T_a_b.y, 6) + "," + FixedText(T_a_b.theta, 9) +
            "," + FixedText(attempt.score, 6) + "," + FixedText(attempt.mahalanobis, 6) + "," +
            std::to_string(attempt.votes) + "," + StateName(attempt.state) + "," +
            Field(attempt.reason) + "\n";
  }
  WriteFile(path, text);
}

}  // namespace masked_mapper
