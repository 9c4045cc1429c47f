// SPDX-License-Identifier: BSD-3-Clause
#include "link_rows.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "masked_mapper/map/drives.hpp"
#include "row_values.hpp"

namespace masked_mapper {
namespace {

class Linker {
 public:
  Linker(std::int64_t version, BuildingMap& map) : version_(version), map_(map) {}

  // What names another row must name one that there is, and that fits.
  void Link() {
    std::vector<Node> nodes = map_.graph.nodes();
    for (Node& node : nodes) {
      if (node.HasScan()) node.scan = ScanOf(node);
    }
    std::vector<Edge> edges = map_.graph.edges();
    if (version_ <= 2) NameClosures(edges);
    PoseGraph linked;
    for (const Floor& floor : map_.graph.floors()) linked.AddFloor(floor);
    for (const Node& node : nodes) linked.AddNode(node);
    for (Edge& edge : edges) {
      if (edge.closure >= 0 && !IsOf(edge)) Malformed("edges", "an edge of another closure");
      linked.AddEdge(std::move(edge));
    }
    map_.graph = std::move(linked);
  }

 private:
  // Before version 3 a node's scan need not be among the kept ones: the one kept next to it is.
  KeptScanId ScanOf(const Node& node) const {
    const std::vector<KeptScan>& kept = map_.kept_scans;
    if (version_ > 2) {
      if (static_cast<std::size_t>(node.scan) < kept.size()) return node.scan;
      Malformed("nodes", "a node of a scan that does not exist");
    }
    const auto off = [&](const KeptScan& scan) { return std::abs(scan.scan.stamp - node.stamp); };
    const auto nearest = std::min_element(
        kept.begin(), kept.end(),
        [&](const KeptScan& one, const KeptScan& other) { return off(one) < off(other); });
    return nearest == kept.end() ? -1 : static_cast<KeptScanId>(nearest - kept.begin());
  }

  // Before version 3 the closures of a pair stand among the edges in the order of their records,
  // and lead from the newer node to the older.
  void NameClosures(std::vector<Edge>& edges) const {
    std::map<std::pair<NodeId, NodeId>, std::vector<ClosureId>> unnamed;
    for (std::size_t i = map_.closures.size(); i-- > 0;) {
      const Closure& closure = map_.closures[i];
      if (closure.state != ClosureState::kValidated) continue;
      unnamed[{closure.newer, closure.older}].push_back(static_cast<ClosureId>(i));
    }
    for (Edge& edge : edges) {
      const auto found = unnamed.find({edge.from, edge.to});
      if (edge.kind != EdgeKind::kClosure || found == unnamed.end() || found->second.empty()) {
        continue;
      }
      edge.closure = found->second.back();
      found->second.pop_back();
      std::swap(edge.from, edge.to);
      edge.T_from_to = Inverse(edge.T_from_to);
    }
  }

  bool IsOf(const Edge& edge) const {
    const auto id = static_cast<std::size_t>(edge.closure);
    if (edge.kind != EdgeKind::kClosure || id >= map_.closures.size()) return false;
    const Closure& closure = map_.closures[id];
    return closure.state == ClosureState::kValidated && closure.older == edge.from &&
           closure.newer == edge.to;
  }

  std::int64_t version_;
  BuildingMap& map_;
};

}  // namespace

void LinkRows(std::int64_t version, BuildingMap& map) { Linker(version, map).Link(); }

void CheckDrives(const BuildingMap& map) {
  if (map.drives.size() < 2) return;
  for (std::size_t drive = 0; drive < map.drives.size(); ++drive) {
    const IndexRange nodes = NodesOfDrive(map, drive);
    const IndexRange poses = PosesOfDrive(map, drive);
    for (std::size_t i = poses.begin; i < poses.end; ++i) {
      const auto node = static_cast<std::size_t>(map.trajectory[i].node_before);
      if (node < nodes.begin || node >= nodes.end) {
        Malformed("drives", "a pose at a node of another drive");
      }
    }
  }
  for (std::size_t i = 1; i < map.kept_scans.size(); ++i) {
    if (map.kept_scans[i].trajectory_index <= map.kept_scans[i - 1].trajectory_index) {
      Malformed("scans", "scans that do not follow each other");
    }
  }
}

}  // namespace masked_mapper
