// SPDX-License-Identifier: MIT
#include "compile_time.hpp"

#include <array>
#include <chrono>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace bench {
namespace {

void runOnce(std::string skc, std::string file, std::string folder) {
  std::string output = "-o";
  std::array<char*, 5> arguments = {skc.data(), output.data(), folder.data(), file.data(), nullptr};
  pid_t child = 0;
  if (posix_spawn(&child, skc.c_str(), nullptr, nullptr, arguments.data(), environ) != 0) {
    throw std::runtime_error(fmt::format("cannot start '{}'", skc));
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (status != 0) throw std::runtime_error(fmt::format("skc fails on '{}'", file));
}

}  // namespace

Quartiles compileTime(const std::filesystem::path& skc, const std::filesystem::path& file,
                      const std::filesystem::path& folder, int rounds) {
  std::filesystem::create_directories(folder);
  runOnce(skc, file, folder);
  std::vector<double> milliseconds;
  for (int round = 0; round < rounds; ++round) {
    const auto start = std::chrono::steady_clock::now();
    runOnce(skc, file, folder);
    milliseconds.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  return quartilesOf(milliseconds);
}

}  // namespace bench
