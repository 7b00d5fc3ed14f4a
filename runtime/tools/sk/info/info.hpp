// SPDX-License-Identifier: MIT
//
// The command `sk info`: the devices of this machine, their capacity, arithmetic and speed, as a table for
// people or as JSON for programs. Measured once per driver.
#pragma once

namespace CLI {
class App;
}

namespace sk_tool {

void addInfo(CLI::App& app);

}  // namespace sk_tool
