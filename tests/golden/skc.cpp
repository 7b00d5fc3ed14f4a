// SPDX-License-Identifier: MIT
#include "skc.hpp"

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace golden {

Outcome run(const fs::path& folder, const std::string& command) {
  const fs::path output = fs::path(SK_WORK_FOLDER) / "output.txt",
                 errors = fs::path(SK_WORK_FOLDER) / "errors.txt";
  fs::create_directories(SK_WORK_FOLDER);
  const int status = std::system(("cd '" + folder.string() + "' && " + command + " > '" + output.string() +
                                  "' 2> '" + errors.string() + "'")
                                     .c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readFile(output), readFile(errors)};
}

Outcome skc(const std::string& arguments, const fs::path& file) {
  return run(file.parent_path(), "'" SK_SKC "' " + arguments + " '" + file.filename().string() + "'");
}

std::string readFile(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void writeFile(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

fs::path workFolder(const std::string& name) {
  const fs::path folder = fs::path(SK_WORK_FOLDER) / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

}  // namespace golden
