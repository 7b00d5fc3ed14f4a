// SPDX-License-Identifier: MIT
//
// sk, the companion tool: each command is a folder of its own, and adds itself here.
#include <cstdio>
#include <exception>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "accuracy/accuracy.hpp"
#include "info/info.hpp"

int main(int argc, char** argv) {
  CLI::App app{"sk: what StreamKernel can tell of this machine.", "sk"};
  app.set_version_flag("--version", "sk " SK_VERSION);
  app.require_subcommand(1);
  sk_tool::addInfo(app);
  sk_tool::addAccuracy(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& stop) {  // --help and --version among them
    return app.exit(stop) == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sk: %s\n", error.what());
    return 1;
  }
  return 0;
}
