// SPDX-License-Identifier: MIT
//
// The pyramid of passes by which the first GPU programs folded N x N texels to one, beside the reduce declarations of today.
#include <algorithm>
#include <cmath>

#include "classics/support/classic.hpp"
#include "reduction.sk.hpp"
#include "sk/sum_bounds.hpp"

namespace {

using namespace reduction;
using Pyramid = std::vector<sk::Stream<float>>;

/// N x N, N/2 x N/2, ... 1 x 1, where half of an odd extent is rounded up.
Pyramid pyramidOf(sk::Device& device, int n) {
  Pyramid levels;
  for (; n > 0; n = n > 1 ? (n + 1) / 2 : 0) levels.push_back(device.stream<float>({n, n}));
  return levels;
}

float fold(const auto& pass, Pyramid& levels) {
  for (std::size_t k = 1; k < levels.size(); ++k) pass(levels[k - 1], levels[k]);
  return levels.back().read()[0];
}

std::int64_t passesOf(sk::Device& device, const std::function<void()>& calls) {
  device.countPasses(true);
  calls();
  const std::int64_t passes = device.passCount().passes;
  device.countPasses(false);
  return passes;
}

/// What is added. A device that computes in double has terms of that precision.
struct Terms {
  Pyramid& levels;
  double n = 0, sum = 0, magnitude = 0;

  /// Adds in doubles, with what each addition loses (Knuth's TwoSum): right to far more than the bits of a float.
  explicit Terms(Pyramid& pyramid) : levels(pyramid) {
    double lost = 0;
    for (const double term : levels[0].readReals()) {
      const double next = sum + term, added = next - sum;
      lost += (sum - (next - added)) + (term - added);
      sum = next;
      magnitude += std::abs(term);
      ++n;
    }
    sum += lost;
  }
};

/// Draws the levels of up to 256 x 256 elements. A sum is shown divided by 4^k, for level k.
void draw(examples::Image& image, int bottom, const Pyramid& levels, bool areSums, float white) {
  int left = 0, widest = 256;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const int extent = static_cast<int>(levels[k].shape()[0]),
              scale = widest / extent;  // pixels along an element
    if (scale == 0) continue;
    std::vector<float> values = levels[k].read();
    const float share = areSums ? std::ldexp(1.0f, -2 * static_cast<int>(k)) : 1;
    for (float& value : values) value = std::sqrt(share * value);  // the root shows what is faint
    const examples::Image level = classics::fieldPicture(values, extent, extent, 0, white, "ember", scale);
    paste(image, level, left, bottom - level.height);
    left += level.width + 10;
    widest = widest * 3 / 4;
  }
}

void sumAndMaximum(classics::Run& run, Pyramid& levels) {
  const float most = std::ranges::max(levels[0].read()), white = std::sqrt(most);
  examples::Image picture = examples::plainImage(960, 522, {1, 1, 1});
  fold(reduceSum, levels);
  draw(picture, 256, levels, true, white);
  const auto byHand = [&] { fold(reduceMax, levels); };
  const auto what = fmt::format("maximum, pyramid of {} passes / reduce", passesOf(run.device(), byHand));
  run.ratio(what, byHand, [&] { largest(levels[0]); });
  run.timed(byHand);
  draw(picture, 522, levels, false, white);
  run.picture("reduction.png", picture);
  run.check(fmt::format("maximum, {:.5f}, by the pyramid and by reduce", most),
            std::abs(levels.back().read()[0] - most) + std::abs(largest(levels[0]) - most), 0,
            "nothing is rounded");
}

/// As in reduction.sk.
unsigned then(unsigned first, unsigned second) {
  unsigned both = 0;
  for (unsigned i = 0; i < 24; i += 3) both |= (first >> (3 * (second >> i & 7)) & 7) << i;
  return both;
}

void foldInOrder(classics::Run& run) {
  auto shuffles = run.device().stream<unsigned>({run.size(), run.size()});
  exchanges(8, shuffles);
  unsigned deck = 076543210;
  for (const unsigned shuffle : shuffles.read()) deck = then(deck, shuffle);
  run.check(fmt::format("eight cards after {} exchanges, {:08o}", run.size() * run.size(), deck),
            deck == shuffled(shuffles) ? 0 : 1, 0, "the order of elements is kept");
}

void addInAllWays(classics::Run& run, const Terms& light, const Terms& cancelling) {
  using enum sk::Accumulate;
  const auto& [levels, n, sum, magnitude] = cancelling;
  run.say("{} terms add up to s = {:.7g}, their magnitudes to S = {:.4g}", n, sum, magnitude);
  double worst = 0;  // of the galaxy
  const auto add = [](auto& t, auto how) { return total.with({.accumulate = how})(t.levels[0]); };
  const auto report = [&](const char* name, const char* reason, const auto& boundOf, const auto& way) {
    double found = 0, time = 1e30, ofTree = 1e30;
    for (int round = 0; round < 9; ++round) {
      time = std::min(time, run.milliseconds([&] { found = way(cancelling); }));
      ofTree = std::min(ofTree, run.milliseconds([&] { add(cancelling, Tree); }));
    }
    const auto row = fmt::format("  {:<11} {:>2} passes, {:>5.2f} of Tree's time, {:>12.7g}", name,
                                 passesOf(run.device(), [&] { way(cancelling); }), time / ofTree, found);
    run.check(row, std::abs(found - sum), boundOf(cancelling), reason);
    worst = classics::larger(worst, std::abs(way(light) - light.sum) / boundOf(light));
  };
  const auto twoAPass = [](const Terms& t) { return 0x1p-23 * double(t.levels.size() - 1) * t.magnitude; };
  report("the pyramid", "2 log2 N u S", twoAPass, [](auto& t) { return fold(reduceSum, t.levels); });
  const auto declared = [&](const char* name, const char* reason, sk::Accumulate how) {
    const sk::SummingDevice device{run.device().profile() == "native", true, false, true};
    const auto boundOf = [&](const Terms& t) {
      const sk::SumFacts facts{how, sk::Precision::Single, false, t.n, t.n, t.magnitude, t.sum};
      return how == Exact ? 0x1p-24 * std::abs(t.sum) : boundOfSum(facts, device);
    };
    report(name, reason, boundOf, [&](auto& t) { return add(t, how); });
  };
  declared("Tree", "d u S", Tree);
  declared("Compensated", "u s + 2 d^2 u^2 S", Compensated);
  declared("Extended", "u s + d 2^-44 S", Extended);
  declared("Exact", "u s", Exact);
  run.check(fmt::format("sum of the galaxy, {:.7g}", light.sum), worst, 1, "all ways, over the same bounds");
}

}  // namespace

int main(int argc, char** argv) {
  classics::Classic about{"reduction", "Buck, Purcell 2004; Harris 2005", "elements a side", 4000, 16, 6000};
  return classics::run(argc, argv, about, [](classics::Run& run) {
    Pyramid levels = pyramidOf(run.device(), run.size()), cancelling = pyramidOf(run.device(), run.size());
    galaxy(2004, levels[0]);
    sumAndMaximum(run, levels);
    foldInOrder(run);
    laplacian(levels[0], cancelling[0]);
    addInAllWays(run, Terms(levels), Terms(cancelling));
  });
}
