// SPDX-License-Identifier: MIT
//
// The command `sk serve`: a page with an editor for .sk files, their messages, their GLSL and their picture, for the browsers of
// this machine alone.
#pragma once

namespace CLI {
class App;
}

namespace sk_tool {

void addServe(CLI::App& app);

}  // namespace sk_tool
