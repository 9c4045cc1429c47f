// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/options/option_table.hpp"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>
#include <type_traits>
#include <utility>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

/// The shortest text that reads back the same; without an exponent where people write none.
std::string NumberText(double value) {
  char buffer[64];
  const bool plain = value == 0.0 || (std::abs(value) >= 1e-4 && std::abs(value) < 1e15);
  const auto format = plain ? std::chars_format::fixed : std::chars_format::general;
  const auto [end, error] = std::to_chars(std::begin(buffer), std::end(buffer), value, format);
  assert(error == std::errc());
  static_cast<void>(error);
  return {buffer, end};
}

/// The whole of `text` as a number, or false.
template <typename Number>
bool Parse(std::string_view text, Number& value) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

bool ParseValue(const std::string& text, double& value) {
  return Parse(text, value) && std::isfinite(value);
}
bool ParseValue(const std::string& text, int& value) { return Parse(text, value); }
bool ParseValue(const std::string& text, std::size_t& value) { return Parse(text, value); }
bool ParseValue(const std::string& text, bool& value) {
  value = text == "true";
  return text == "true" || text == "false";
}

/// Names of topics and the like: nothing that YAML or JSON would have to escape.
bool ParseValue(const std::string& text, std::string& value) {
  constexpr std::size_t kLongest = 1000;
  value = text;
  return text.size() <= kLongest && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
                  std::string_view("/_,.- ").find(c) != std::string_view::npos;
         });
}

template <typename Enum>
Choice ChoiceOf(Enum& field) {
  const auto names = NamesOf(field);
  return {{names.begin(), names.end()},
          [&field] { return static_cast<std::size_t>(field); },
          [&field](std::size_t index) { field = static_cast<Enum>(index); }};
}

template <typename Value>
std::string TypeName() {
  if (std::is_same_v<Value, bool>) return "true or false";
  if (std::is_same_v<Value, std::string>) return "a name";
  return std::is_same_v<Value, double> ? "a number" : "a whole number";
}

/// The nearest key; when only the section was forgotten or wrong, the key that ends alike.
std::string NearestKey(const std::string& unknown, const std::vector<OptionEntry>& table) {
  std::vector<std::string> keys;
  keys.reserve(table.size());
  for (const OptionEntry& entry : table) keys.push_back(entry.key);
  std::string near = DidYouMean(unknown, keys);
  if (!near.empty()) return near;
  const auto last_name = [](const std::string& key) { return key.substr(key.rfind('.') + 1); };
  for (const std::string& key : keys) {
    if (last_name(key) == last_name(unknown)) return " (did you mean `" + key + "`?)";
  }
  return {};
}

/// A user's text inside a message: one line, not too long.
std::string Quoted(std::string text) {
  constexpr std::size_t kLongest = 60;
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  for (char& letter : text) {
    if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f) letter = '?';
  }
  return "`" + text + "`";
}

}  // namespace

std::vector<OptionEntry> OptionTable(Options& o) {
  constexpr double kFar = 1000.0;  // m; no distance that makes sense here is longer
  MotionOptions& motion = o.mapping.motion;
  OpeningsMaskOptions& openings = o.mapping.masks.openings;
  return {
      {"threads", &o.threads, 0, 256, "0: as many as the machine has; never changes the result"},

      {"log.max_range", &o.mapping.log.max_range, 0, kFar,
       "m; at or beyond it nothing was hit; 0: found from the log"},
      {"log.min_range", &o.mapping.log.min_range, 0, 10, "m; anything nearer says nothing"},
      {"log.laser_x", &o.mapping.log.laser_x, -10, 10,
       "m; scanner on the robot; 0, 0, 0: as the log says"},
      {"log.laser_y", &o.mapping.log.laser_y, -10, 10, "m; to the left"},
      {"log.laser_theta_deg", &o.mapping.log.laser_theta_deg, -180, 180, "deg; counter-clockwise"},
      {"log.upside_down", &o.mapping.log.upside_down, 0, 0,
       "the scanner hangs: beams run the other way than the log says"},
      {"log.field_of_view_deg", &o.mapping.log.field_of_view_deg, 0, 360,
       "deg; of FLASER lines; 0: by the number of beams"},
      {"log.scan_topic", &o.mapping.log.scan_topic, 0, 0,
       "of ROS bags with several; a,b: merged into one scanner"},
      {"log.odometry_topic", &o.mapping.log.odometry_topic, 0, 0,
       "of ROS bags with several; none: not read"},
      {"log.odom_frame", &o.mapping.log.odom_frame, 0, 0,
       "of ROS bags: odometry is tf below it; empty: found"},
      {"log.imu_topic", &o.mapping.log.imu_topic, 0, 0, "of ROS bags with several; none: not read"},
      {"log.pressure_topic", &o.mapping.log.pressure_topic, 0, 0,
       "of ROS bags with several; none: not read"},
      {"log.strongest_echo", &o.mapping.log.strongest_echo, 0, 0,
       "of a scanner with several echoes per beam; false: the first"},

      {"motion.source", ChoiceOf(motion.source), 0, 0,
       "auto: fused where scans come often enough, else odometry"},
      {"motion.odometry.sigma_position_per_sqrt_m", &motion.odometry.sigma_position_per_sqrt_m,
       1e-6, 10, "m of position error after one metre of travel"},
      {"motion.odometry.sigma_heading_deg_per_sqrt_m",
       &motion.odometry.sigma_heading_deg_per_sqrt_m, 1e-6, 90,
       "deg of heading error after one metre of travel"},
      {"motion.odometry.sigma_heading_deg_per_sqrt_rad",
       &motion.odometry.sigma_heading_deg_per_sqrt_rad, 0, 90,
       "deg of heading error after turning by a radian"},
      {"motion.odometry.sigma_heading_deg_per_sqrt_s",
       &motion.odometry.sigma_heading_deg_per_sqrt_s, 0, 90,
       "deg of heading error after a second (gyro drift)"},
      {"motion.odometry.sigma_position_per_step", &motion.odometry.sigma_position_per_step, 1e-6, 1,
       "m of position error of every step with motion"},

      {"floors.source", ChoiceOf(o.mapping.floors.source), 0, 0,
       "what tells floors apart; auto: the best that the log holds"},
      {"floors.file", &o.mapping.floors.file, 0, 0,
       "lines `t,label`, stand for the log's FLOOR lines (--floors)"},
      {"floors.storeys.min_gap", &o.mapping.floors.storeys.min_gap, 0.5, 100,
       "m between two floors at least"},
      {"floors.storeys.typical_height", &o.mapping.floors.storeys.typical_height, 0.5, 100,
       "m between floors where nothing measures it"},

      {"nodes.min_edge_length_m", &o.mapping.nodes.min_edge_length_m, 0.1, kFar,
       "m between scan nodes, straight line; paper: 1.5"},
      {"nodes.max_edge_length_m", &o.mapping.nodes.max_edge_length_m, 0.1, kFar,
       "m to the last node of any kind; paper: 9"},
      {"nodes.kept_scan_distance_m", &o.mapping.nodes.kept_scan_distance_m, 0, kFar,
       "m of travel from one rendered scan to the next"},

      {"masks.eccentricity.open_below", &o.mapping.masks.eccentricity.open_below, 0, 1,
       "eccentricity below which a corridor has opened"},
      {"masks.eccentricity.corridor_above", &o.mapping.masks.eccentricity.corridor_above, 0, 1,
       "eccentricity above which a place is a corridor"},
      {"masks.openings.detection.min_width_m", &openings.detection.min_width_m, 0, kFar,
       "m; paper: 0.75"},
      {"masks.openings.min_turn_deg", &openings.min_turn_deg, 0, 180,
       "deg off the course, at least; paper: 40"},
      {"masks.openings.max_turn_deg", &openings.max_turn_deg, 0, 180,
       "deg off the course, at most; paper: 90"},

      {"candidates.max_mahalanobis", &o.mapping.closures.candidates.max_mahalanobis, 0, 1000,
       "distance of a pair still matched; MaxMaha of the paper: 5"},
      {"candidates.max_matches", &o.mapping.closures.candidates.max_matches, 0, 10000,
       "pairs offered per node; MaxMatches of the paper: 5"},

      {"matcher.min_score", &o.mapping.closures.matcher.min_score, 0, 1,
       "how much scans must overlap; MinScore of the paper: 0.425"},
      {"matcher.max_window_m", &o.mapping.closures.matcher.max_window_m, 0.3, 100,
       "m; half the search window at most"},
      {"matcher.max_window_deg", &o.mapping.closures.matcher.max_window_deg, 3, 180,
       "deg; half the search window at most"},

      {"validator.rule", ChoiceOf(o.mapping.closures.validator.rule), 0, 0,
       "evidence: odds against chance; paper: votes of loops"},
      {"validator.votes_needed", &o.mapping.closures.validator.votes_needed, 1, 1000,
       "loops that must agree, by the paper's rule; paper: 6"},

      {"grid.resolution_m", &o.grid.resolution_m, 0.01, 1, "m; side of a cell of the grid"},
      {"grid.max_usable_range_m", &o.grid.max_usable_range_m, 0.5, kFar,
       "m; beams are drawn up to here"},
      {"grid.free_range_without_return_m", &o.grid.free_range_without_return_m, 0, kFar,
       "m that a beam clears which met nothing; 0: it does not"},
      {"grid.forget", &o.grid.forget, 0, 0,
       "newer drives stand for older ones where they saw enough"},

      {"octree.wall_height_m", &o.octree.wall_height_m, 0.01, 100,
       "m; walls reach from the floor's elevation up to here"},
      {"octree.free_height_m", &o.octree.free_height_m, 0.01, 100,
       "m of free space, rounded to a power of two of voxels"},
  };
}

std::string ValueText(const OptionEntry& entry) {
  struct {
    std::string operator()(const bool* field) const { return *field ? "true" : "false"; }
    std::string operator()(const double* field) const { return NumberText(*field); }
    std::string operator()(const std::string* field) const { return *field; }
    std::string operator()(const int* field) const { return std::to_string(*field); }
    std::string operator()(const std::size_t* field) const { return std::to_string(*field); }
    std::string operator()(const Choice& choice) const { return choice.names.at(choice.get()); }
  } text;
  return std::visit(text, entry.field);
}

std::string RangeText(const OptionEntry& entry) {
  if (std::holds_alternative<bool*>(entry.field)) return "true or false";
  if (std::holds_alternative<std::string*>(entry.field)) return "a name";
  const auto* choice = std::get_if<Choice>(&entry.field);
  if (choice == nullptr) return NumberText(entry.min) + " to " + NumberText(entry.max);
  std::string names;
  for (std::size_t i = 0; i < choice->names.size(); ++i) {
    if (i > 0) names += i + 1 < choice->names.size() ? ", " : " or ";
    names += choice->names[i];
  }
  return names;
}

void SetOption(const std::string& where, const std::string& key, const std::string& value,
               Options& options) {
  const std::vector<OptionEntry> table = OptionTable(options);
  const auto entry = std::find_if(table.begin(), table.end(),
                                  [&](const OptionEntry& known) { return known.key == key; });
  if (entry == table.end()) {
    throw InputError(where + ": unknown option " + Quoted(key) + NearestKey(key, table));
  }
  const auto fail = [&](const std::string& expected) {
    throw InputError(where + ": " + key + " must be " + expected + ", not " + Quoted(value));
  };
  if (const auto* choice = std::get_if<Choice>(&entry->field)) {
    const auto name = std::find(choice->names.begin(), choice->names.end(), value);
    if (name == choice->names.end()) fail(RangeText(*entry));
    choice->set(static_cast<std::size_t>(name - choice->names.begin()));
    return;
  }
  std::visit(
      [&](auto field) {
        if constexpr (!std::is_same_v<decltype(field), Choice>) {
          using Value = std::remove_pointer_t<decltype(field)>;
          Value parsed{};
          if (!ParseValue(value, parsed)) fail(TypeName<Value>());
          if constexpr (!std::is_same_v<Value, std::string>) {
            const auto number = static_cast<double>(parsed);
            if (!std::is_same_v<Value, bool> && (number < entry->min || number > entry->max)) {
              fail(RangeText(*entry));
            }
          }
          *field = parsed;
        }
      },
      entry->field);
}

void SetOption(const std::string& assignment, Options& options) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) {
    throw InputError("--set " + Quoted(assignment) + ": expected key=value");
  }
  SetOption("--set", assignment.substr(0, equals), assignment.substr(equals + 1), options);
}

void CheckOptions(const Options& options) {
  struct Order {
    const char* least_key;
    double least;
    const char* most_key;
    double most;
  };
  const NodeOptions& nodes = options.mapping.nodes;
  const OpeningsMaskOptions& openings = options.mapping.masks.openings;
  const EccentricityMaskOptions& eccentricity = options.mapping.masks.eccentricity;
  for (const Order& order : {
           Order{"nodes.min_edge_length_m", nodes.min_edge_length_m, "nodes.max_edge_length_m",
                 nodes.max_edge_length_m},
           Order{"masks.openings.min_turn_deg", openings.min_turn_deg,
                 "masks.openings.max_turn_deg", openings.max_turn_deg},
           Order{"masks.eccentricity.open_below", eccentricity.open_below,
                 "masks.eccentricity.corridor_above", eccentricity.corridor_above},
       }) {
    if (order.least > order.most) {
      throw InputError(std::string(order.least_key) + " (" + NumberText(order.least) +
                       ") must not be above " + order.most_key + " (" + NumberText(order.most) +
                       ")");
    }
  }
  if (options.mapping.log.max_range > 0.0 &&
      options.mapping.log.min_range >= options.mapping.log.max_range) {
    throw InputError("log.min_range (" + NumberText(options.mapping.log.min_range) +
                     ") must be below log.max_range (" + NumberText(options.mapping.log.max_range) +
                     ")");
  }
  const FloorSource source = options.mapping.floors.source;
  if (!options.mapping.floors.file.empty() && source != FloorSource::kAuto &&
      source != FloorSource::kLabels) {
    throw InputError("a file of floors needs floors.source auto or labels");
  }
}

std::vector<std::pair<std::string, OptionValue>> OptionValues(const Options& options) {
  struct {
    OptionValue operator()(const bool* field) const { return *field; }
    OptionValue operator()(const double* field) const { return *field; }
    OptionValue operator()(const int* field) const { return std::int64_t{*field}; }
    OptionValue operator()(const std::size_t* field) const {
      return static_cast<std::int64_t>(*field);
    }
    OptionValue operator()(const std::string* field) const { return *field; }
    OptionValue operator()(const Choice& choice) const { return choice.names.at(choice.get()); }
  } value;
  Options copy = options;
  std::vector<std::pair<std::string, OptionValue>> values;
  for (const OptionEntry& entry : OptionTable(copy)) {
    if (entry.key != "threads") values.emplace_back(entry.key, std::visit(value, entry.field));
  }
  return values;
}

}  // namespace masked_mapper
