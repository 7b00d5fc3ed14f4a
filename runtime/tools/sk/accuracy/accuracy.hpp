// SPDX-License-Identifier: MIT
//
// The command `sk accuracy`: what each choice of precision, storage, accumulation and functions costs on a device, and how
// exact it is there, in one run; as a table, as JSON and as a chart.
#pragma once

namespace CLI {
class App;
}

namespace sk_tool {

void addAccuracy(CLI::App& app);

}  // namespace sk_tool
