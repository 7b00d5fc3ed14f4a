// SPDX-License-Identifier: MIT
#include "command.hpp"

#include <array>
#include <cstdio>
#include <stdexcept>

#include <fmt/format.h>
#include <sys/wait.h>

#include "markdown.hpp"

namespace docs {

namespace fs = std::filesystem;

// The script goes by a file, which needs no quoting.
Outcome run(const std::string& command, const fs::path& folder) {
  const fs::path script = fs::path(SK_DOCS_WORK) / fmt::format("{}.command.sh", folder.filename().string());
  fs::create_directories(script.parent_path());
  writeFile(script, fmt::format("cd '{}' || exit 1\nPATH='{}':$PATH\n{}\n", folder.string(),
                                fs::path(SK_DOCS_SKC).parent_path().string(), command));
  FILE* pipe = popen(fmt::format("bash '{}' 2>&1 </dev/null", script.string()).c_str(), "r");
  if (!pipe) throw std::runtime_error("no shell");
  Outcome outcome{-1, {}};
  std::array<char, 4096> buffer;
  while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe)) {
    outcome.output.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

fs::path workFolder(const std::string& name) {
  const fs::path folder = fs::path(SK_DOCS_WORK) / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

}  // namespace docs
