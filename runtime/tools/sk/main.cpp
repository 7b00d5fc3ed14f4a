// SPDX-License-Identifier: MIT
//
// sk, the companion tool: each command has its own folder and registers itself here.
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include "assemble/nearest_word.hpp"
#include "commands.hpp"

namespace {

/// Returns "; did you mean '--json'?" for the first word that is not a command or an option, or "".
std::string suggestion(const CLI::App& app) {
  std::vector<std::string> known;
  const CLI::App* command = &app;
  for (const CLI::App* inner : app.get_subcommands()) command = inner;  // the command that was called
  for (const CLI::App* inner : command->get_subcommands({})) known.push_back(inner->get_name());
  for (const CLI::Option* option : command->get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  for (const std::string& word : app.remaining(true)) {
    const std::string_view nearest = sk::assemble::nearestWord(word.substr(0, word.find('=')), known);
    return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
  }
  return {};
}

/// The error message for an invalid command line.
std::string mistake(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> rest = app.remaining();
  const bool isCommand = app.get_subcommands().empty() && !rest.empty() && !rest.front().starts_with("-");
  return (isCommand ? fmt::format("there is no command '{}'", rest.front()) : error.what()) + suggestion(app);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"sk: what StreamKernel can tell of this machine.", "sk"};
  app.set_version_flag("--version", "sk " SK_VERSION);
  app.require_subcommand(1);
  sk_tool::addInfo(app);
  sk_tool::addAccuracy(app);
  sk_tool::addScale(app);
  sk_tool::addServe(app);
  sk_tool::addShadow(app);
  sk_tool::addStress(app);
  sk_tool::addTune(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& stop) {  // also --help and --version
    if (stop.get_exit_code() == 0) return app.exit(stop);
    fmt::print(stderr, "sk: {}\nsee 'sk --help'\n", mistake(app, stop));
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sk: %s\n", error.what());
    return 1;
  }
  return 0;
}
