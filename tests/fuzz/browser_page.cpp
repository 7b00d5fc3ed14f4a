// SPDX-License-Identifier: MIT
#include "browser_page.hpp"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include <sys/wait.h>

#include "temporary_folder.hpp"

namespace fuzz {

std::map<std::uint64_t, std::string> reportsOf(const std::filesystem::path& folder, const std::string& page) {
  static const TemporaryFolder package;  // is built once for all pages
  const TemporaryFolder output;
  const std::string found = (output.path() / "found").string(), here = SK_SOURCE_FOLDER "/tests/fuzz/";
  std::string command = "python3";
  for (const std::string& argument :
       {here + "browser.py", folder.string(), std::string(SK_SOURCE_FOLDER), std::string(SK_BUILD_FOLDER),
        (package.path() / "built").string(), here + page})
    command += " '" + argument + "'";
  constexpr int hung = 3;  // browser.py's
  const int status = std::system((command + " >'" + found + "'").c_str());
  if (WIFEXITED(status) && WEXITSTATUS(status) == hung) throw HungPage("the browser's page hangs");
  if (status != 0) throw std::runtime_error("the browser does not run " + page);
  std::map<std::uint64_t, std::string> reports;
  std::ifstream in(found);
  for (std::string line; std::getline(in, line);)
    reports[std::stoull(line)] = line.substr(line.find(": ") + 2);
  return reports;
}

}  // namespace fuzz
