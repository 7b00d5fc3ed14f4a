// SPDX-License-Identifier: MIT
#include "serve/own_host.hpp"

#include <catch2/catch.hpp>

using sk_tool::isOwnHost;
using sk_tool::isOwnOrigin;

TEST_CASE("A server knows its own names") {
  for (const int port : {80, 8000}) {
    CAPTURE(port);
    CHECK(isOwnHost("127.0.0.1:" + std::to_string(port), port));
    CHECK(isOwnHost("localhost:" + std::to_string(port), port));
    CHECK(isOwnHost("127.0.0.1", port) == (port == 80));  // browsers leave port 80 out
    CHECK(isOwnHost("localhost", port) == (port == 80));
    for (const char* other :
         {"", "localhost:", "localhost:8001", "example.org", "localhost.example.org", "127.0.0.1:80000"}) {
      CHECK_FALSE(isOwnHost(other, port));
    }
    CHECK(isOwnOrigin("http://localhost:" + std::to_string(port), port));
    CHECK(isOwnOrigin("http://127.0.0.1", port) == (port == 80));
    CHECK_FALSE(isOwnOrigin("https://localhost:" + std::to_string(port), port));
    CHECK_FALSE(isOwnOrigin("null", port));
  }
}
