// SPDX-License-Identifier: MIT
//
// skc, the compiler of StreamKernel files.
#include "driver/big_stack.hpp"
#include "driver/compile.hpp"
#include "driver/options.hpp"

int main(int argc, char** argv) {
  const skc::driver::CommandLine line = skc::driver::parseCommandLine(argc, argv);
  if (!line.options) return line.status;
  return skc::driver::withBigStack([&] {
    int status = 0;
    for (const std::string& file : line.options->files) {
      if (skc::driver::compile(*line.options, file) != 0) status = 1;
    }
    return status;
  });
}
