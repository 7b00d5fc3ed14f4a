// SPDX-License-Identifier: MIT
//
// `sk scale`: predicts how the kernels of a file scale over many devices.
#pragma once

namespace CLI {
class App;
}

namespace sk_tool {

void addScale(CLI::App& app);

}  // namespace sk_tool
