// SPDX-License-Identifier: MIT
//
// The names under which browsers reach a server of this machine. A page of another name, which may lead here all the same, gets no
// answer.
#pragma once

#include <string_view>

namespace sk_tool {

/// Whether a request's Host names the server on this port: "127.0.0.1:8000" or "localhost:8000". Browsers leave port 80 out.
bool isOwnHost(std::string_view given, int port);

/// Whether a request's Origin is a page of that server: "http://127.0.0.1:8000".
bool isOwnOrigin(std::string_view given, int port);

}  // namespace sk_tool
