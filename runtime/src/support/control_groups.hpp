// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sk {

/// The folders of the control groups that limit this process, its own first and then those around it. A controller's name, such as
/// "memory" or "cpu", asks for the first version of control groups, and "" for the second. Files are read below `root`. In a
/// container, the path may not exist, and its own group is the outermost one.
std::vector<std::string> controlGroups(const std::filesystem::path& root, std::string_view controller);

}  // namespace sk
