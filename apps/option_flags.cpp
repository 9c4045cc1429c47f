// SPDX-License-Identifier: BSD-3-Clause
#include "option_flags.hpp"

#include "masked_mapper/options/option_table.hpp"

namespace masked_mapper {

void AddOptionFlags(CLI::App& command, OptionFlags& flags) {
  command
      .add_option("--config", flags.configuration,
                  "YAML file with the options to change (config/default.yaml holds all)")
      ->type_name("FILE");
  command
      .add_option("--set", flags.settings,
                  "change one option, such as matcher.min_score=0.5; wins over --config")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
}

Options ReadOptions(const OptionFlags& flags) {
  Options options;
  if (!flags.configuration.empty()) ReadConfiguration(flags.configuration, options);
  for (const std::string& setting : flags.settings) SetOption(setting, options);
  CheckOptions(options);
  return options;
}

}  // namespace masked_mapper
