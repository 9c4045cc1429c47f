// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/map_file/saved_map.hpp"

#include <cstddef>
#include <map>

#include "masked_mapper/options/option_table.hpp"

namespace masked_mapper {

NamedValues ChangedOptions(const Options& options) {
  Options ours = options;
  Options defaults;
  const std::vector<OptionEntry> table = OptionTable(ours);
  const std::vector<OptionEntry> default_table = OptionTable(defaults);
  NamedValues changed;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].key == "threads") continue;  // it changes nothing
    std::string value = ValueText(table[i]);
    if (value != ValueText(default_table[i])) changed.emplace_back(table[i].key, std::move(value));
  }
  return changed;
}

bool IsOfDrawing(const std::string& option_key) {
  return option_key.rfind("grid.", 0) == 0 || option_key.rfind("octree.", 0) == 0;
}

NamedValues KeyOf(const MapOrigin& origin) {
  NamedValues key = {{"log", origin.log}, {"mask", origin.mask}};
  for (std::size_t i = 0; i < origin.later_logs.size(); ++i) {
    const std::string number = std::to_string(i + 2);
    key.emplace_back("log " + number, origin.later_logs[i].log);
    if (!origin.later_logs[i].floors.empty()) {
      key.emplace_back("floors of log " + number, origin.later_logs[i].floors);
    }
  }
  if (!origin.onto.empty()) key.emplace_back("--onto", origin.onto);
  Options options = origin.options;
  for (const OptionEntry& entry : OptionTable(options)) {
    if (entry.key == "threads" || IsOfDrawing(entry.key)) continue;
    key.emplace_back(entry.key, ValueText(entry));
  }
  return key;
}

std::string FirstDifference(const NamedValues& before, const NamedValues& now) {
  std::map<std::string, std::string> old(before.begin(), before.end());
  for (const auto& [key, value] : now) {
    const auto found = old.find(key);
    if (found == old.end()) return key + " was not known, now it is " + value;
    if (found->second != value) return key + " was " + found->second + ", now it is " + value;
  }
  const std::map<std::string, std::string> asked(now.begin(), now.end());
  for (const auto& [key, value] : before) {
    if (asked.count(key) == 0) return key + " was " + value + ", now there is none";
  }
  return "";
}

std::string DifferenceFrom(const MapOrigin& before, const MapOrigin& now) {
  return FirstDifference(KeyOf(before), KeyOf(now));
}

}  // namespace masked_mapper
