// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <random>

#include "classics/support/classic.hpp"
#include "points.sk.hpp"

namespace {

using namespace points;

constexpr classics::Classic about{"points", "Krueger, Westermann 2003", "pages along a side", 500, 8, 1000};
constexpr int linksOfPage = 5, none = -1, pixels = 400;
constexpr float follows = 0.85f;     ///< the part of a surfer's steps that follow a link
constexpr float nearEnough = 1e-6f;  ///< of two steps, to end

/// The links of pages on a grid, sorted by row, which is the page that a link leads to. Each new page links to older ones
/// nearby, or to what these link to, and half of the links are returned.
std::vector<Vertex> growWeb(int side) {
  std::mt19937 random(2003);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const auto near = [&](int i, int reach) {
    const int low = std::max(i - reach, 0), high = std::min(i + reach, side - 1);
    return low + below(high - low + 1);
  };
  std::vector<int> pages(side * side), target(linksOfPage * side * side, none), degree(side * side, 0);
  for (int page = 0; page < side * side; ++page) pages[page] = page;
  std::ranges::shuffle(pages, random);
  std::fill_n(target.begin() + linksOfPage * pages[0], linksOfPage, pages[0]);
  std::vector<Vertex> links;
  for (const int page : std::span(pages).subspan(1)) {
    for (int link = linksOfPage; link-- > 0;) {
      int other = page;
      for (int reach = 1; target[linksOfPage * other] == none; reach = std::min(2 * reach, side))
        other = side * near(page / side, reach) + near(page % side, reach);
      if (below(5) < 2) other = target[linksOfPage * other + below(linksOfPage)];
      target[linksOfPage * page + link] = other;
      links.push_back({other, page, 0});
      if (below(2) == 0) links.push_back({page, other, 0});
    }
  }
  for (const Vertex& link : links) ++degree[link.texcoord];
  for (Vertex& link : links) link.colour = 1.0f / degree[link.texcoord];
  std::ranges::sort(links, {}, [](const Vertex& v) { return std::pair(v.position, v.texcoord); });
  return links;
}

void surfWeb(classics::Run& run) {
  sk::Device& device = run.device();
  const auto upload = [&]<class T>(const std::vector<T>& elements) {
    auto stream = device.stream<T>({elements.size()});
    stream.write(elements);
    return stream;
  };
  const int side = run.size(), n = side * side;
  const std::vector<Vertex> a = growWeb(side);
  std::vector<int> start(n + 1, 0);
  for (const Vertex& v : a) ++start[v.position + 1];
  const int longest = *std::ranges::max_element(start);
  for (int row = 0; row < n; ++row) start[row + 1] += start[row];
  // Array k has the entries from 4 k to 4 k + 3 of each row, in one point.
  std::vector<std::vector<Vertex4>> arrays((longest + 3) / 4);
  for (int row = 0; row < n; ++row) {
    const auto entry = [&](int i) { return i < start[row + 1] ? a[i] : Vertex{row, 0, 0}; };
    for (int i = start[row]; i < start[row + 1]; i += 4) {
      const Vertex p = entry(i), q = entry(i + 1), r = entry(i + 2), s = entry(i + 3);
      arrays[(i - start[row]) / 4].push_back(
          {row, {p.texcoord, q.texcoord, r.texcoord, s.texcoord}, {p.colour, q.colour, r.colour, s.colour}});
    }
  }
  std::vector<sk::Stream<Vertex4>> vertexArrays;
  for (const auto& array : arrays) vertexArrays.push_back(upload(array));
  run.say("{} links of {} pages, {} of them to one; points of four links make {} arrays, the first of {}",
          a.size(), n, longest, arrays.size(), arrays[0].size());
  const auto entries = upload(a), backwards = upload(std::vector(a.rbegin(), a.rend()));
  auto rank = device.stream<float>({n}), y = device.stream<float>({n});
  auto change = device.scalar<float>();
  auto done = device.scalar<bool>();
  rank.fill(1.0f / float(n));
  sk::Loop surfing = device.record([&] {
    y.fill(0);
    clMatVec(entries, rank, y);
    surf(follows, n, y, rank, rank, change);
    done = change < nearEnough;
  });
  std::int64_t steps = 0;
  const double took = run.timed([&] { steps = surfing.until(done, {.every = 4, .most = 200}); });
  const sk::Rows rows(upload(start));
  const auto draw = [&](const sk::Stream<Vertex>& vertices, sk::Order order) {
    y.fill(0);
    clMatVec.with({.order = order})(vertices, rank, y);
  };
  const auto inOrder = [&] { draw(entries, sk::Order::Kept); };
  const auto inAnyOrder = [&] { draw(entries, sk::Order::Any); };
  const auto byArrays = [&] {
    y.fill(0);
    for (const auto& array : vertexArrays) clMatVec4(array, rank, y);
  };
  const auto byRows = [&](sk::Accumulate sums) { clRow.with({.accumulate = sums})(rows(entries), rank, y); };
  run.ratio("points in order / points in any order", inOrder, inAnyOrder);
  run.ratio("points in order / arrays of points", inOrder, byArrays);
  run.ratio("points in order / rows", inOrder, [&] { byRows(sk::Accumulate::Tree); });

  const auto ranks = rank.readReals();
  std::vector<double> exact(n, 0), first;
  for (const Vertex& v : a) exact[v.position] += double{v.colour} * ranks[v.texcoord];
  const std::tuple<std::string_view, std::function<void()>, double, std::string_view> ways[] = {
      {"points in order", inOrder, longest + 1., "a product and the sums of the longest row"},
      {"points backwards", [&] { draw(backwards, sk::Order::Kept); }, longest + 1., "the same"},
      {"points in any order", inAnyOrder, longest + 1., "the same"},
      {"arrays of points", byArrays, longest / 4 + 5., "four at once"},
      {"rows", [&] { byRows(sk::Accumulate::Compensated); }, 2, "compensated sums"},
      {"rows, summed exactly", [&] { byRows(sk::Accumulate::Exact); }, 1.01, "one rounding"}};
  for (const auto& [way, multiply, roundings, reason] : ways) {
    multiply();
    const auto got = y.readReals();
    if (first.empty()) first = got;
    double error = 0, differing = 0;
    for (int i = 0; i < n; ++i) {
      error = classics::larger(error, std::abs(got[i] - exact[i]) / std::max(exact[i], 1e-30));
      differing += got[i] != first[i];
    }
    run.check(fmt::format("{} ({:.0f} elements differ)", way, differing), error, roundings * 0x1p-24, reason);
  }
  double residual = 0;
  for (int i = 0; i < n; ++i) residual += std::abs(follows * exact[i] + (1 - follows) / n - ranks[i]);
  run.check(fmt::format("page rank in {} steps of {:.3g} ms", steps, took / double(steps)), residual,
            2 * nearEnough, "the last change, and rounding");
  auto sorted = ranks;
  std::ranges::sort(sorted, std::greater());
  auto drawn = device.stream<unsigned>({pixels, 2 * pixels});
  auto discs = device.stream<float>({pixels, pixels});
  auto colours = device.stream<sk::float3>({pixels, 2 * pixels});
  drawn.fill(0);
  discs.fill(0);
  const auto left = drawn.domain({0, 0}, {pixels, pixels}),
             right = drawn.domain({0, pixels}, {pixels, 2 * pixels});
  drawEntries(n, pixels, entries, left);
  drawLinks(side, pixels, float(sorted[16]), entries, rank, right);
  drawPages(side, pixels, rank, discs);
  paintEntries(left, colours.domain({0, 0}, {pixels, pixels}));
  paintWeb(right, discs, colours.domain({0, pixels}, {pixels, 2 * pixels}));
  run.picture("points.png", examples::imageOf(2 * pixels, pixels, colours.read()));
}

}  // namespace

int main(int argc, char** argv) { return classics::run(argc, argv, about, surfWeb); }
