// SPDX-License-Identifier: MIT
#include "support/control_groups.hpp"

#include <fstream>
#include <string>

namespace sk {

// Strings, since paths of libstdc++ 12 free memory twice where it is exhausted while they are joined.
std::vector<std::string> controlGroups(const std::filesystem::path& root, std::string_view controller) {
  const std::string start = root.string() == "/" ? std::string() : root.string();
  std::string own;  // the outermost group if no line tells
  std::ifstream in(start + "/proc/self/cgroup");
  for (std::string line;
       std::getline(in, line);) {  // NUMBER:CONTROLLERS:/PATH; version 2 names no controllers
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos || line.size() <= second + 1) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const bool isOurs = controller.empty()
                            ? line.starts_with("0::/")
                            : controllers.find("," + std::string(controller) + ",") != std::string::npos;
    if (isOurs) own = line.substr(second + 1);
  }
  while (own.ends_with('/')) own.pop_back();
  std::vector<std::string> folders;
  const std::string all =
      start + "/sys/fs/cgroup" + (controller.empty() ? "" : "/" + std::string(controller));
  for (;; own.resize(own.rfind('/'))) {
    folders.push_back(all + own);
    if (own.find('/') == std::string::npos) return folders;
  }
}

}  // namespace sk
