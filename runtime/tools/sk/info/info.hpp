// SPDX-License-Identifier: MIT
//
// The command `sk info`: what the devices of this machine are, what they can hold, how they compute and what things
// cost on them, as a table for people or as JSON for programs. Measured once for each driver.
#pragma once

namespace CLI {
class App;
}

namespace sk_tool {

void addInfo(CLI::App& app);

}  // namespace sk_tool
