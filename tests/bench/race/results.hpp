// SPDX-License-Identifier: MIT
//
// What a session has measured, as the JSON that report.py reads; torch_peer.py writes the same.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "session.hpp"

namespace race {

/// {"machine": {...}, "runs": [{"program", "log2", "element", "operations", "bytes", "contender", "ours", "seconds"}],
/// "absent": [...]}.
nlohmann::json resultsOf(const Session& session, const std::string& renderer);

}  // namespace race
