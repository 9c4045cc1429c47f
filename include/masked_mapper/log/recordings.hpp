// SPDX-License-Identifier: BSD-3-Clause
// Which of several files are one recording: recorders split what they write, and only the first
// part tells again what is said but once (static transforms).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "masked_mapper/log/log_source.hpp"

namespace masked_mapper {

/// The files of each recording, in the order of recording; recordings in the order of their first
/// file among those given. Bags of the same topics of which one begins as the other ends are one;
/// anything else stands by itself. Throws InputError when a bag cannot be read.
std::vector<std::vector<std::string>> RecordingsOf(const std::vector<std::string>& files);

/// One of them. Throws InputError when it cannot be read as a log.
std::unique_ptr<LogSource> OpenRecording(const std::vector<std::string>& files,
                                         const LogOptions& options);

}  // namespace masked_mapper
