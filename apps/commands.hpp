// SPDX-License-Identifier: BSD-3-Clause
// What the dispatcher knows of its subcommands: how each adds itself.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace masked_mapper {

/// What the command line asks for, set while it is parsed and run afterwards. Returns the exit
/// code; throws InputError for what is the user's fault.
using Run = std::function<int()>;

void AddEvaluateCommand(CLI::App& program, Run& run);
void AddExportCommand(CLI::App& program, Run& run);
void AddInfoCommand(CLI::App& program, Run& run);
void AddLocalizeCommand(CLI::App& program, Run& run);
void AddMapCommand(CLI::App& program, Run& run);
void AddRouteCommand(CLI::App& program, Run& run);
void AddSimulateCommand(CLI::App& program, Run& run);

}  // namespace masked_mapper
