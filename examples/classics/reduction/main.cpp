// SPDX-License-Identifier: MIT
//
// The pyramid of passes by which the first GPU programs folded N x N texels to one, beside the reduce declarations of today.
#include <algorithm>
#include <cmath>

#include <sk/sum_bounds.hpp>

#include "classics/support/classic.hpp"
#include "reduction.sk.hpp"

namespace {

using Pyramid = std::vector<sk::Stream<float>>;

/// N x N, N/2 x N/2, ... 1 x 1, where half of an odd extent is rounded up.
Pyramid pyramidOf(sk::Device& device, int n) {
  Pyramid levels;
  levels.push_back(device.stream<float>({n, n}));
  for (; n > 1; levels.push_back(device.stream<float>({n, n}))) n = (n + 1) / 2;
  return levels;
}

/// What rounding a sum at each of its additions changes at most: two for each pass, one after the other.
double errorOf(const Pyramid& levels, double sum) { return 2.0 * double(levels.size() - 1) * 0x1p-24 * sum; }

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

/// The sum in doubles, with what each addition loses (Knuth's TwoSum): right to far more than the bits of a float.
double exactSum(const std::vector<float>& values) {
  double sum = 0, lost = 0;
  for (const double value : values) {
    const double next = sum + value, added = next - sum;
    lost += (sum - (next - added)) + (value - added);
    sum = next;
  }
  return sum + lost;
}

/// Draws the levels of up to 256 x 256 elements. A sum is shown divided by 4^k, for level k.
void draw(examples::Image& image, int bottom, const Pyramid& levels, bool areSums, float white) {
  const auto n = static_cast<int>(levels[0].shape()[0]);
  int left = 0, widest = 256;
  for (int k = 0; k < static_cast<int>(levels.size()); ++k) {
    const int extent = (n + (1 << k) - 1) >> k, scale = widest / extent;  // pixels along an element
    if (scale == 0) continue;
    std::vector<float> values = levels[static_cast<std::size_t>(k)].read();
    const float share = areSums ? std::ldexp(1.0f, -2 * k) : 1;
    for (float& value : values) value = std::sqrt(share * value);  // the root shows what is faint
    const examples::Image level = classics::fieldPicture(values, extent, extent, 0, white, "ember", scale);
    paste(image, level, left, bottom - level.height);
    left += level.width + 10;
    widest = widest * 3 / 4;
  }
}

void sumAndMaximum(classics::Run& run, Pyramid& levels) {
  using namespace reduction;
  const std::vector<float> light = levels[0].read();
  const double n = static_cast<double>(light.size()), mean = exactSum(light) / n;
  const float most = *std::ranges::max_element(light), white = std::sqrt(most);
  examples::Image picture = examples::plainImage(960, 522, {1, 1, 1});
  const double sum = fold(reduceSum, levels);
  draw(picture, 256, levels, true, white);
  const auto byHand = [&] { fold(reduceMax, levels); };
  const auto what = fmt::format("maximum, pyramid of {} passes over reduce", passesOf(run.device(), byHand));
  run.ratio(what, byHand, [&] { largest(levels[0]); });
  float found = 0;
  run.timed([&] { found = fold(reduceMax, levels); });
  draw(picture, 522, levels, false, white);
  run.picture("reduction.png", picture);
  run.check(fmt::format("maximum, {:.5f}, by the pyramid and by reduce", most),
            std::abs(found - most) + std::abs(largest(levels[0]) - most), 0, "nothing is rounded");
  run.check(fmt::format("mean of {} elements, {:.5f}", light.size(), mean), std::abs(sum / n - mean),
            errorOf(levels, mean), "2 log2 N additions, one after the other");
}

/// As in reduction.sk.
unsigned then(unsigned first, unsigned second) {
  unsigned both = 0;
  for (unsigned i = 0; i < 24; i += 3) both |= (first >> (3 * (second >> i & 7)) & 7) << i;
  return both;
}

void foldInOrder(classics::Run& run) {
  auto shuffles = run.device().stream<unsigned>({run.size(), run.size()});
  reduction::exchanges(8, shuffles);
  const std::vector<unsigned> all = shuffles.read();
  unsigned deck = 076543210;
  for (const unsigned shuffle : all) deck = then(deck, shuffle);
  run.check(fmt::format("eight cards after {} exchanges, {:08o}", all.size(), deck),
            deck == reduction::shuffled(shuffles) ? 0 : 1, 0, "the order of elements is kept");
}

void sumsThatCancel(classics::Run& run, Pyramid& levels) {
  using enum sk::Accumulate;
  const std::vector<float> terms = levels[0].read();
  const double n = static_cast<double>(terms.size()), sum = exactSum(terms);
  double magnitude = 0;
  for (const float term : terms) magnitude += std::abs(term);
  run.say("{} terms add up to s = {:.7g}, their magnitudes to S = {:.4g}", n, sum, magnitude);
  const auto add = [&](sk::Accumulate how) { return reduction::total.with({.accumulate = how})(levels[0]); };
  const auto report = [&](const char* name, const char* reason, double bound, const auto& way) {
    double found = 0, time = 1e30, ofTree = 1e30;
    for (int round = 0; round < 9; ++round) {
      time = std::min(time, run.milliseconds([&] { found = way(); }));
      ofTree = std::min(ofTree, run.milliseconds([&] { add(Tree); }));
    }
    const auto row = fmt::format("  {:<11} {:>2} passes, {:>5.2f} of Tree's time, {:>12.7g}", name,
                                 passesOf(run.device(), way), time / ofTree, found);
    run.check(row, std::abs(found - sum), bound, reason);
  };
  const auto byHand = [&] { return fold(reduction::reduceSum, levels); };
  report("the pyramid", "2 log2 N u S", errorOf(levels, magnitude), byHand);
  const auto declared = [&](const char* name, const char* reason, sk::Accumulate how) {
    const sk::SumFacts facts{how, sk::Precision::Single, false, n, n, magnitude, sum};
    const sk::SummingDevice device{run.device().profile() == "native", true, false, true};
    const double bound = how == Exact ? 0x1p-24 * std::abs(sum) : boundOfSum(facts, device);
    report(name, reason, bound, [&] { return add(how); });
  };
  declared("Tree", "d u S", Tree);
  declared("Compensated", "u s + 2 d^2 u^2 S", Compensated);
  declared("Extended", "u s + d 2^-44 S", Extended);
  declared("Exact", "u s", Exact);
}

}  // namespace

int main(int argc, char** argv) {
  classics::Classic about{"reduction", "Buck, Purcell 2004; Harris 2005", "elements a side", 4000, 1, 6000};
  return classics::run(argc, argv, about, [](classics::Run& run) {
    Pyramid levels = pyramidOf(run.device(), run.size()), cancelling = pyramidOf(run.device(), run.size());
    reduction::galaxy(2004, levels[0]);
    sumAndMaximum(run, levels);
    foldInOrder(run);
    reduction::laplacian(levels[0], cancelling[0]);
    sumsThatCancel(run, cancelling);
  });
}
