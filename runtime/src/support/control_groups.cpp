// SPDX-License-Identifier: MIT
#include "support/control_groups.hpp"

#include <fstream>
#include <string>

namespace sk {

std::vector<std::filesystem::path> controlGroups(const std::filesystem::path& root,
                                                 std::string_view controller) {
  std::filesystem::path own;  // the outermost group if no line tells
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line;
       std::getline(in, line);) {  // NUMBER:CONTROLLERS:/PATH; version 2 names no controllers
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos || line.size() <= second + 1) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const bool isOurs = controller.empty()
                            ? line.starts_with("0::/")
                            : controllers.find("," + std::string(controller) + ",") != std::string::npos;
    if (isOurs) own = line.substr(second + 2);
  }
  std::vector<std::filesystem::path> folders;
  const std::filesystem::path all = root / "sys/fs/cgroup" / controller;
  for (std::filesystem::path group = own;; group = group.parent_path()) {
    folders.push_back(all / group);
    if (group.empty() || !group.has_relative_path()) return folders;
  }
}

}  // namespace sk
