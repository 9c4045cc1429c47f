// SPDX-License-Identifier: BSD-3-Clause
// CARMEN text (DESIGN, Logs), plain or gzip, read ahead by two threads: one decompresses, one
// parses. What is handed out does not depend on their timing, and memory does not grow with the
// log.
#pragma once

#include <memory>
#include <string>

#include "log_plan.hpp"

namespace masked_mapper {

/// Looks at the beginning of the log, at all of it when the beginning does not tell what "no
/// return" is. Throws InputError: no such file, a folder, empty, binary.
std::unique_ptr<LogPlan> PlanCarmenLog(const std::string& path, const LogOptions& options);

}  // namespace masked_mapper
