// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace masked_mapper {

/// viewer/dist/viewer.html, compiled in. Where kReportDataMark stands, once, the data belongs.
std::string_view ViewerPage();

constexpr std::string_view kReportDataMark = "@REPORT_DATA@";

}  // namespace masked_mapper
