// SPDX-License-Identifier: MIT
#include "commands.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "serve/compilation.hpp"
#include "serve/server.hpp"

namespace sk_tool {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uintmax_t largestProgram = std::uintmax_t{256} << 10;   // what the server takes

struct Options {
  std::string file;
  int port = 8080, seconds = ProcessLimits().cpuSeconds;
  std::string skc;
};

std::string environmentOf(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

fs::path folderOfSk() { return fs::read_symlink("/proc/self/exe").parent_path(); }

bool isProgram(const fs::path& file) {
  return fs::is_regular_file(file) && ::access(file.c_str(), X_OK) == 0;
}

/// The path of skc: what the user names, the one beside sk, or the one on PATH.
std::string findSkc(const std::string& given) {
  std::string wanted = given.empty() ? environmentOf("SK_SKC") : given;
  if (wanted.empty() && isProgram(folderOfSk() / "skc")) return (folderOfSk() / "skc").string();
  if (wanted.empty()) wanted = "skc";
  if (wanted.find('/') != std::string::npos) {
    if (isProgram(wanted)) return fs::absolute(wanted).string();
  } else {
    std::istringstream folders(environmentOf("PATH"));
    for (std::string folder; std::getline(folders, folder, ':');) {
      if (isProgram(fs::path(folder) / wanted)) return fs::absolute(fs::path(folder) / wanted).string();
    }
  }
  throw std::runtime_error(
      fmt::format("there is no program '{}' to compile with; name one by --skc FILE or SK_SKC", wanted));
}

/// The folder that has playground/: SK_SHARE, else the installation's or the build folder's.
fs::path shareFolder() {
  if (const std::string chosen = environmentOf("SK_SHARE"); !chosen.empty()) return chosen;
  const fs::path installed = folderOfSk() / SK_SHARE_FROM_BIN;
  for (const fs::path& folder : {installed, folderOfSk().parent_path() / "share" / "streamkernel"}) {
    if (fs::is_directory(folder / "playground")) return folder.lexically_normal();
  }
  return installed.lexically_normal();
}

/// The text of a file that the user names. Throws std::runtime_error if it is none, or too large.
std::string programOf(const std::string& file) {
  std::error_code error;
  if (!fs::exists(file, error)) throw std::runtime_error(fmt::format("there is no file '{}'", file));
  if (fs::is_directory(file, error))
    throw std::runtime_error(fmt::format("'{}' is a folder; name a .sk file", file));
  if (fs::file_size(file, error) > largestProgram) {
    throw std::runtime_error(
        fmt::format("'{}' has more than {} kB, too much for the playground", file, largestProgram >> 10));
  }
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw std::runtime_error(fmt::format("'{}' cannot be read", file));
  return text;
}

/// What the page shows first: the user's file as it is now, and the programs to start with.
std::string startOf(const std::string& file, const Assets& assets) {
  json programs = json::array();
  for (const auto& [name, text] : assets.programs) programs.push_back({{"name", name}, {"text", text}});
  json start{{"programs", programs},
             {"hasPackage", assets.hasPackage},
             {"hasEditor", assets.hasEditor},
             {"file", nullptr}};
  if (!file.empty())
    start["file"] = {{"name", fs::path(file).filename().string()}, {"text", programOf(file)}};
  return start.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// What is missing of the page, and how to get it.
void warnOf(const Assets& assets) {
  if (!assets.hasPackage) {
    fmt::print(stderr,
               "sk: pages have no pictures without the npm package; 'cmake --build build/release --target "
               "playground' makes it, "
               "with TypeScript's compiler (Debian: node-typescript)\n");
  }
  if (!assets.hasEditor) {
    fmt::print(stderr,
               "sk: pages have a plain editor without CodeMirror; 'cmake --build build/release --target "
               "playground' gets it, "
               "with npm\n");
  }
}

ProcessLimits limitsOfCompilations(int seconds) {
  ProcessLimits limits{.cpuSeconds = seconds, .wallTime = std::chrono::seconds(3 * seconds)};
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  limits.memory = 0;   // the sanitizers reserve terabytes of address space
#endif
  return limits;
}

void run(const Options& options) {
  if (!options.file.empty()) programOf(options.file);   // a mistake shows before the page
  const std::string skc = findSkc(options.skc);
  const ProcessLimits limits = limitsOfCompilations(options.seconds);
  Service service{
      .assets = readAssets(shareFolder()), .port = options.port, .start = {}, .compile = {}, .started = {}};
  warnOf(service.assets);
  service.start = [&] { return startOf(options.file, service.assets); };
  service.compile = [&](const std::string& text) { return compileForPage(skc, text, limits); };
  service.started = [](const std::string& address) {
    fmt::print("The playground is at {} for browsers of this machine, until Ctrl-C.\n", address);
    std::fflush(stdout);
  };
  serve(service);
}

}  // namespace

void addServe(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("serve",
                         "Serves a page to browsers of this machine: an editor for .sk files, their "
                         "messages, their GLSL and their picture (docs/playground.md)");
  command->add_option("FILE", options->file, "The .sk file that the page shows first; it is not written to");
  command
      ->add_option("--port", options->port,
                   "The port of 127.0.0.1, or 0 for one that is free (default: 8080)")
      ->check(CLI::Range(0, 65535))
      ->type_name("N");
  command
      ->add_option("--skc", options->skc,
                   "The compiler skc (default: SK_SKC, the one beside sk, the one on PATH)")
      ->type_name("FILE");
  command
      ->add_option("--seconds", options->seconds,
                   "Seconds of CPU time that a compilation may take (default: 10)")
      ->check(CLI::Range(1, 3600))
      ->type_name("N");
  command->callback([options] { run(*options); });
}

}  // namespace sk_tool
