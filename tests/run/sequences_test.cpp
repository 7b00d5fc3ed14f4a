// SPDX-License-Identifier: MIT
//
// Long random sequences of operations that change streams: writes, calls on views (in place, too), reduces, streams that are
// made and destroyed, in planes and in boxes, on several devices in turn. After each step, all streams are compared with
// plain arrays, so a call that reads what it has written, or writes beside its outputs, is found.
#include <optional>
#include <random>

#include "sequences.sk.hpp"
#include "support/devices.hpp"
#include "support/folds.hpp"

using namespace run_tests;

namespace {

/// A stream and what it should hold.
struct Pair {
  sk::Stream<int> stream;
  HostArray<int> host;
};

/// A box of the stream of a pair.
struct Box {
  std::size_t pair;
  sk::Index begin;
  sk::Shape shape;
};

bool overlap(const Box& a, const Box& b) {
  bool overlaps = a.pair == b.pair;
  for (int d = 0; d < a.shape.rank(); ++d)
    overlaps = overlaps && a.begin[d] < b.begin[d] + b.shape[d] && b.begin[d] < a.begin[d] + a.shape[d];
  return overlaps;
}

/// Wraps a sum as devices do.
int wrapped(std::int64_t v) { return static_cast<int>(static_cast<std::uint32_t>(v)); }
std::int64_t mirrored(std::int64_t i, std::int64_t n) {
  const std::int64_t m = ((i % (2 * n)) + 2 * n) % (2 * n);
  return m < n ? m : 2 * n - 1 - m;
}
std::int64_t repeated(std::int64_t i, std::int64_t n) { return ((i % n) + n) % n; }

class Sequence {
 public:
  Sequence(sk::Device& device, int rank, unsigned seed) : device_(device), rank_(rank), random_(seed) {
    for (std::size_t i = 0; i < 6; ++i) pairs_.push_back(made());
  }

  void step() {
    switch (below(6)) {
      case 0: pairs_[below(pairs_.size())] = made(); break;
      case 1: write(); break;
      case 2: fold(); break;
      default: call(); break;
    }
    compare();
  }

 private:
  std::size_t below(std::size_t n) { return random_() % n; }
  std::int64_t extent() { return 1 + static_cast<std::int64_t>(below(below(3) == 0 ? 70 : 12)); }

  Pair made() {
    sk::Shape shape{extent(), 1 + extent() % 55};  // up to 64 x 64 elements on a small device
    if (rank_ == 3) shape = {1 + extent() % 8, 1 + extent() % 12, 1 + extent() % 20};
    const std::uint32_t seed = random_();
    HostArray<int> host(
        shape, [&](std::size_t i) { return static_cast<int>(hashed(seed + static_cast<std::uint32_t>(i))); });
    return {host.on(device_), host};
  }

  /// A random box of at least one element in a random stream.
  Box box() {
    const std::size_t pair = below(pairs_.size());
    const sk::Shape& whole = pairs_[pair].host.shape();
    if (below(4) == 0) return {pair, sk::Index::origin(rank_), whole};
    sk::Shape shape = whole;
    for (int d = 0; d < rank_; ++d)
      shape = shape.with(d, 1 + static_cast<std::int64_t>(below(static_cast<std::size_t>(whole[d]))));
    return {pair, beginOf(shape, whole), shape};
  }
  sk::Index beginOf(const sk::Shape& shape, const sk::Shape& whole) {
    sk::Index begin = sk::Index::origin(rank_);
    for (int d = 0; d < rank_; ++d)
      begin[d] = static_cast<std::int64_t>(below(static_cast<std::size_t>(whole[d] - shape[d] + 1)));
    return begin;
  }
  /// A random box of this shape; `repeats` allows extent 1 in one dimension instead. Gives up after a few streams that are
  /// too small.
  std::optional<Box> boxOf(sk::Shape shape, bool repeats) {
    if (repeats && below(3) == 0) shape = shape.with(anyDimension(), 1);
    for (int attempt = 0; attempt < 8; ++attempt) {
      const std::size_t pair = below(pairs_.size());
      const sk::Shape& whole = pairs_[pair].host.shape();
      bool fits = true;
      for (int d = 0; d < rank_; ++d) fits = fits && whole[d] >= shape[d];
      if (fits) return Box{pair, beginOf(shape, whole), shape};
    }
    return std::nullopt;
  }

  int anyDimension() { return static_cast<int>(below(static_cast<std::size_t>(rank_))); }

  sk::View<int> view(const Box& box) {
    sk::Index end = box.begin;
    for (int d = 0; d < rank_; ++d) end[d] += box.shape[d];
    return pairs_[box.pair].stream.domain(box.begin, end);
  }
  HostArray<int> held(const Box& box) const {
    return HostArray<int>(box.shape, [&](std::size_t i) {
      return pairs_[box.pair].host[inside(box.begin, positionOf(box.shape, i))];
    });
  }
  void hold(const Box& box, const HostArray<int>& elements) {
    for (std::size_t i = 0; i < elements.elements().size(); ++i) {
      pairs_[box.pair].host[inside(box.begin, positionOf(box.shape, i))] = elements.elements()[i];
    }
  }

  void write() {
    const Box target = box();
    const std::uint32_t seed = random_();
    const HostArray<int> elements(target.shape, [&](std::size_t i) { return static_cast<int>(seed + i); });
    view(target).write(elements.elements());
    hold(target, elements);
  }

  void fold() {
    const Box source = box();
    const HostArray<int> x = held(source);
    const auto add = [](int& r, int v) { r = wrapped(std::int64_t{r} + v); };
    CHECK(sequences::sum(view(source)) == foldBox(x, {}, x.shape(), 0, add));
    const auto target = boxOf(x.shape().with(anyDimension(), 1), false);
    if (!target) return;
    sequences::sum(view(source), view(*target));
    hold(*target, foldBlocks(x, target->shape, 0, add));
  }

  void call() {
    const Box r = box();
    const auto s = boxOf(r.shape, false), x = boxOf(r.shape, true), y = boxOf(r.shape, true);
    if (!s || !x || !y || overlap(r, *s)) return;
    const Box g = box();
    const HostArray<int> hx = held(*x), hy = held(*y), hg = held(g);
    const int k = static_cast<int>(random_());
    if (rank_ == 2) sequences::mixed(k, view(*x), view(*y), view(g), view(r), view(*s));
    if (rank_ == 3) sequences::mixedBox(k, view(*x), view(*y), view(g), view(r), view(*s));
    const sk::Shape& n = hg.shape();
    const auto at = [&](std::int64_t px, std::int64_t py) {
      return std::int64_t{hg[{mirrored(py, n[0]), mirrored(px, n[1])}]};
    };
    const auto gathered = [&](const Position& p) {
      if (rank_ == 2) return at(p[1] + 1, p[0] - 2) + at(p[0], p[1]);
      return hg[{repeated(p[0] + 3, n[0]), repeated(p[1] - 2, n[1]), repeated(p[2] + 1, n[2])}] + p[2] +
             10 * p[1] + 100 * p[0];
    };
    hold(r, HostArray<int>(r.shape, [&](std::size_t i) {
           const auto p = positionOf(r.shape, i);
           return wrapped(std::int64_t{3} * hx.repeated(p) + hy.repeated(p) + k);
         }));
    hold(*s, HostArray<int>(r.shape, [&](std::size_t i) {
      const auto p = positionOf(r.shape, i);
      return wrapped(gathered(p) - hx.repeated(p));
    }));
  }

  void compare() {
    const Box whole = box();
    CHECK(difference(view(whole).read(), held(whole).elements()) == "");
    for (const Pair& pair : pairs_) CHECK(difference(pair.stream.read(), pair.host.elements()) == "");
  }

  sk::Device& device_;
  int rank_;
  std::mt19937 random_;
  std::vector<Pair> pairs_;
};

}  // namespace

TEST_CASE("whatever the order of writes, calls and reduces, streams hold what plain arrays hold") {
  // The first steps need most of the programs, and compiling these takes most of the time.
  Sequence sequences[] = {{device("glsl330"), 2, 1},
                          {device("essl300"), 2, 2},
                          {device("glsl330", smallLimits[1]), 2, 3},
                          {device("glsl330", smallLimits[0]), 3, 4},
                          {device("glsl430", smallLimits[0]), 2, 5},
                          {device("glsl430"), 3, 6}};
  for (int i = 0; i < 60; ++i) {
    INFO("step " << i);
    for (Sequence& sequence : sequences) sequence.step();
  }
}
