// SPDX-License-Identifier: MIT
//
// floyd_warshall.sk against three plain loops, exactly: lengths are small integers.
#include "programs/floyd_warshall.sk.hpp"

#include <limits>

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;
using floyd_warshall::Route;

namespace {

constexpr float none = std::numeric_limits<float>::infinity();

/// A quarter of all edges; edges to places with larger numbers may have negative lengths.
std::vector<float> edges(std::size_t places) {
  std::vector<float> edge(places * places, none);
  for (std::size_t i = 0; i < edge.size(); ++i) {
    const std::uint32_t bits = hashed(static_cast<std::uint32_t>(i) + 17u);
    if (bits % 4 != 0) continue;
    const int length = static_cast<int>(bits >> 8 & 63u) + 1;
    edge[i] = static_cast<float>(i / places < i % places ? length - 3 : length + 60);
  }
  return edge;
}

sk::Stream<Route> shortestRoutes(sk::Device& device, const sk::Stream<float>& edge) {
  const std::int64_t n = edge.shape()[0];
  auto routes = device.stream<Route>({n, n});
  floyd_warshall::start(edge, routes);
  for (std::int64_t k = 0; k < n; ++k) {
    floyd_warshall::relax(routes.domain({0, k}, {n, k + 1}), routes.domain({k, 0}, {k + 1, n}), routes,
                          routes);
  }
  return routes;
}

/// The shortest lengths by the same algorithm, but each step changes the matrix in place.
std::vector<double> shortestLengths(const std::vector<float>& edge, std::size_t n) {
  std::vector<double> length(edge.begin(), edge.end());
  for (std::size_t i = 0; i < n; ++i) length[i * n + i] = 0;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        length[i * n + j] = std::min(length[i * n + j], length[i * n + k] + length[k * n + j]);
      }
    }
  }
  return length;
}

/// The length of the route from one place to another that follows Route::first edge by edge.
double walk(const std::vector<Route>& routes, const std::vector<float>& edge, std::size_t n, std::size_t from,
            std::size_t to) {
  double length = 0;
  for (std::size_t steps = 0; from != to && steps < n; ++steps) {
    const auto next = static_cast<std::size_t>(routes[from * n + to].first);
    REQUIRE(next < n);
    length += edge[from * n + next];
    from = next;
  }
  return from == to ? length : none;
}

}  // namespace

TEST_CASE("floyd-warshall: lengths and ways between all pairs") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::int64_t places : {0, 1, 2, 5, 32, 61}) {
      INFO(places << " places");
      const auto n = static_cast<std::size_t>(places);
      const auto edge = edges(n);
      const auto routes = shortestRoutes(device, streamOf<float>(device, {places, places}, edge)).read();
      const auto length = shortestLengths(edge, n);
      for (std::size_t i = 0; i < n * n; ++i) {
        INFO("from " << i / n << " to " << i % n);
        CHECK(routes[i].length == length[i]);
        if (length[i] < none) CHECK(walk(routes, edge, n, i / n, i % n) == length[i]);
      }
    }
  });
}
