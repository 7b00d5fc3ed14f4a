// SPDX-License-Identifier: MIT
//
// The command `sk accuracy`: measures time and error of each choice of precision, storage, accumulation and
// functions on a device, in one run, and writes a table, JSON and a chart.
#pragma once

namespace CLI {
class App;
}

namespace sk_tool {

void addAccuracy(CLI::App& app);

}  // namespace sk_tool
