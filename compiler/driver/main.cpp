// SPDX-License-Identifier: MIT
//
// skc, the compiler of StreamKernel files.
#include <cstdio>
#include <exception>
#include <new>

#include "driver/big_stack.hpp"
#include "driver/compile.hpp"
#include "driver/crash_report.hpp"
#include "driver/options.hpp"
#include "support/internal_error.hpp"

namespace {

int compileAll(const skc::driver::Options& options) {
  int status = 0;
  for (const std::string& file : options.files) {
    try {
      if (skc::driver::compile(options, file) != 0) status = 1;
    } catch (const std::bad_alloc&) {
      std::fprintf(stderr, "skc: there is not enough memory to compile '%s'\n", file.c_str());
      status = 1;
    } catch (const std::exception& error) {
      skc::internalError(error.what());
    }
  }
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  const skc::driver::CommandLine line = skc::driver::parseCommandLine(argc, argv);
  if (!line.options) return line.status;
  return skc::driver::withBigStack([&] {
    skc::driver::reportCrashes(argc, argv);
    return compileAll(*line.options);
  });
}
