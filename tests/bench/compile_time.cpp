// SPDX-License-Identifier: MIT
#include "compile_time.hpp"

#include <chrono>
#include <cstdlib>
#include <stdexcept>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace bench {
namespace {

using Words = std::vector<std::string>;

void runOnce(Words words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawnp(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0) {
    throw std::runtime_error(fmt::format("cannot start '{}'", words.front()));
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (status != 0) throw std::runtime_error(fmt::format("'{}' fails on '{}'", words.front(), words.back()));
}

/// Milliseconds of all commands, one after the other.
Quartiles timeOf(const std::vector<Words>& commands, int rounds) {
  std::vector<double> milliseconds;
  for (int round = rounds > 1 ? -1 : 0; round < rounds; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (const Words& command : commands) runOnce(command);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    if (round >= 0)
      milliseconds.push_back(time.count());  // the first of several brings the files into memory
  }
  return quartilesOf(milliseconds);
}

Words skcCommand(const std::filesystem::path& skc, const std::filesystem::path& file,
                 const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  ::setenv("SKC_VALIDATE", "off", 1);  // as in builds without tests, which users have
  return {skc.string(), "-o", folder.string(), file.string()};
}

}  // namespace

Quartiles compileTime(const std::filesystem::path& skc, const std::filesystem::path& file,
                      const std::filesystem::path& folder, int rounds) {
  return timeOf({skcCommand(skc, file, folder)}, rounds);
}

Quartiles editTime(const std::filesystem::path& skc, const std::vector<std::string>& compiler,
                   const std::filesystem::path& file, const std::filesystem::path& folder, int rounds) {
  const std::string stub = (folder / file.filename()).string();
  Words compile = compiler;
  compile.insert(compile.end(), {"-c", "-o", stub + ".stub.o", stub + ".cpp"});
  return timeOf({skcCommand(skc, file, folder), compile}, rounds);
}

}  // namespace bench
