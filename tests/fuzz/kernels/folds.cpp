// SPDX-License-Identifier: MIT
#include "kernels/folds.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <deque>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "kernels/untyped.hpp"

namespace fuzz {

namespace {

using Extents = std::array<std::int64_t, 4>;

sk::Shape shapeOf(int rank, const Extents& extents) {
  if (rank == 1) return {extents[0]};
  if (rank == 2) return {extents[0], extents[1]};
  if (rank == 3) return {extents[0], extents[1], extents[2]};
  return {extents[0], extents[1], extents[2], extents[3]};
}

/// A divisor of a number, which may be itself.
std::int64_t divisorOf(std::int64_t number, Random& random) {
  std::vector<std::int64_t> all;
  for (std::int64_t divisor = 1; divisor <= number; ++divisor) {
    if (number % divisor == 0) all.push_back(divisor);
  }
  return all.empty() ? 1 : random.pick(all);
}

/// The number of a shape's element, given its number in `domain`, whose extents it divides.
std::int64_t blockOf(std::int64_t element, const sk::Shape& domain, const sk::Shape& grid) {
  std::int64_t block = 0, step = 1;
  for (int d = domain.rank(); d-- > 0; element /= domain[d]) {
    block += element % domain[d] / (domain[d] / grid[d]) * step;
    step *= grid[d];
  }
  return block;
}

std::uint32_t randomWord(Scalar scalar, Random& random) {
  if (scalar == Scalar::Float) return std::bit_cast<std::uint32_t>(static_cast<float>(random.between(-8, 8)));
  const auto word = static_cast<std::uint32_t>(random.next());
  return random.chance(1, 2) ? word : word % 32;
}

}  // namespace

RandomFold::RandomFold(std::uint64_t seed, std::uint64_t number, FoldKind kind) {
  Random random(seed, number);
  made_ = randomFold(kind, random);
  chooseDomain(random);
  chooseOptions(random);
  fill(random);
  made_.text += described();
}

void RandomFold::chooseDomain(Random& random) {
  if (made_.kind != FoldKind::Kernel && random.chance(1, 4)) {
    chooseRows(random);
    return;
  }
  Extents extents{};
  int rank = 1;
  if (random.chance(1, 4)) {
    extents[0] = random.between(1, mostFolded);
  } else if (random.chance(1, 20)) {
    extents[0] = made_.identities.empty() || made_.kind == FoldKind::Kernel ? 1 : 0;
  } else {
    rank = random.between(1, 4);
    constexpr int most[] = {3000, 80, 20, 9};
    for (int d = 0; d < rank; ++d) extents[static_cast<std::size_t>(d)] = random.between(1, most[rank - 1]);
  }
  domain_ = shapeOf(rank, extents);
  if (made_.kind == FoldKind::Scan) {
    to_ = To::Line;
    const int along = random.between(-1, rank - 1);
    if (along >= 0) options_.along = along;
    return;
  }
  if (domain_.size() == 0 || (made_.kind == FoldKind::Reduce && random.chance(1, 3))) return;
  to_ = To::Blocks;
  Extents grid{};
  const bool isOne = random.chance(1, 3);
  for (int d = 0; d < rank; ++d)
    grid[static_cast<std::size_t>(d)] = isOne ? 1 : divisorOf(domain_[d], random);
  grid_ = shapeOf(rank, grid);
}

void RandomFold::chooseRows(Random& random) {
  to_ = To::Rows;
  const int least = made_.identities.empty() ? 1 : 0;
  const int most = random.pick(std::array{1, 4, 40, 500, 4000});
  std::int32_t at = made_.kind == FoldKind::Scan ? 0 : random.between(0, 5);
  starts_.push_back(at);
  for (int left = random.between(1, random.pick(std::array{1, 30, 3000})); left > 0; --left) {
    const int count =
        random.chance(1, 4) ? least : random.between(least, random.chance(1, 8) ? most : std::min(most, 9));
    if (at + count > mostFolded) break;
    starts_.push_back(at += count);
  }
  if (starts_.size() == 1) starts_.push_back(at += 1);
  if (at == 0) starts_.back() = at = 1;
  domain_ = {made_.kind == FoldKind::Scan ? at : at + random.between(0, 3)};
}

void RandomFold::chooseOptions(Random& random) {
  if (made_.kind == FoldKind::Scan && !made_.identities.empty() && random.chance(1, 3))
    options_.scan = sk::Scan::Exclusive;
  static constexpr sk::Accumulate ways[] = {sk::Accumulate::Default, sk::Accumulate::Tree,
                                            sk::Accumulate::Compensated, sk::Accumulate::Extended,
                                            sk::Accumulate::Exact};
  if (made_.sumsFloats) options_.accumulate = random.pick(ways);
  static constexpr Placement placements[] = {Placement::Whole, Placement::Whole, Placement::Whole,
                                             Placement::Box, Placement::Strided};
  for (std::size_t i = 0; i < made_.inputs.size() + made_.outputs.size() + made_.accumulators.size(); ++i)
    placements_.push_back(random.pick(placements));
  const std::vector<Scalar>& written = made_.kind == FoldKind::Kernel ? made_.outputs : made_.accumulators;
  isInPlace_ = made_.kind != FoldKind::Reduce &&
               made_.inputIsRecord == (made_.kind == FoldKind::Scan && made_.accumulatorIsRecord) &&
               (made_.inputIsRecord ? written == made_.inputs : written[0] == made_.inputs[0]) &&
               random.chance(1, 3);
}

void RandomFold::fill(Random& random) {
  for (const Scalar scalar : made_.inputs) {
    Words& words = inputs_.emplace_back();
    for (std::int64_t i = 0; i < domain_.size(); ++i) words.push_back(randomWord(scalar, random));
  }
  for (std::size_t i = 0; i < tableLength; ++i) table_.push_back(randomWord(Scalar::Int, random));
  factor_ = randomWord(Scalar::Uint, random);
}

std::string RandomFold::described() const {
  std::string text = fmt::format("// over {} elements of rank {}", domain_.size(), domain_.rank());
  if (to_ == To::Rows) text += fmt::format(" in {} rows", starts_.size() - 1);
  if (to_ == To::Blocks) text += fmt::format(" to {}", grid_.size());
  if (options_.along) text += fmt::format(", along {}", *options_.along);
  if (options_.scan == sk::Scan::Exclusive) text += ", without the element";
  if (options_.accumulate != sk::Accumulate::Default)
    text += fmt::format(", accumulation {}", static_cast<int>(options_.accumulate));
  if (isInPlace_) text += ", in place";
  for (const Placement placement : placements_)
    text += placement == Placement::Whole ? "" : placement == Placement::Box ? ", a box" : ", strided";
  return text + "\n";
}

// ---- what it means ---------------------------------------------------------------------------------

Words RandomFold::inputsAt(std::int64_t element) const {
  Words words;
  for (const Words& input : inputs_) words.push_back(input[static_cast<std::size_t>(element)]);
  return words;
}

sk::Shape RandomFold::resultShape() const {
  if (made_.kind == FoldKind::Scan) return domain_;
  if (to_ == To::Rows) return {static_cast<std::int64_t>(starts_.size()) - 1};
  return to_ == To::Blocks ? grid_ : sk::Shape(1);
}

std::vector<std::int64_t> RandomFold::targets() const {
  std::vector<std::int64_t> targets(static_cast<std::size_t>(domain_.size()), 0);
  if (to_ == To::Rows) {
    std::ranges::fill(targets, -1);
    for (std::size_t row = 0; row + 1 < starts_.size(); ++row) {
      for (std::int32_t i = starts_[row]; i < starts_[row + 1]; ++i)
        targets[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(row);
    }
  } else if (to_ == To::Blocks) {
    for (std::size_t i = 0; i < targets.size(); ++i)
      targets[i] = blockOf(static_cast<std::int64_t>(i), domain_, grid_);
  } else if (options_.along) {
    const sk::Shape lines = domain_.with(*options_.along, 1);
    for (std::size_t i = 0; i < targets.size(); ++i)
      targets[i] = blockOf(static_cast<std::int64_t>(i), domain_, lines);
  }
  return targets;
}

RandomFold::Results RandomFold::expected() const {
  const auto count = static_cast<std::size_t>(domain_.size());
  const bool isScan = made_.kind == FoldKind::Scan;
  const std::vector<std::int64_t> targets = this->targets();
  std::int64_t most = resultShape().size() - 1;
  for (const std::int64_t target : targets) most = std::max(most, target);
  std::vector<Words> states(static_cast<std::size_t>(most) + 1, made_.identities);
  Results results;
  results.outputs.resize(made_.outputs.size());
  results.accumulators.resize(made_.accumulators.size());
  const auto row = static_cast<std::size_t>(domain_[domain_.rank() - 1]);
  for (std::size_t i = 0; i < count; ++i) {
    if (targets[i] < 0) continue;
    FoldText::Element element{inputsAt(static_cast<std::int64_t>(i)), factor_, table_,
                              static_cast<std::uint32_t>(i % row), Words(made_.outputs.size())};
    Words& state = states[static_cast<std::size_t>(targets[i])];
    if (state.empty()) state = element.inputs;
    const Words before = state;
    made_.fold(state, element);
    for (std::size_t o = 0; o < results.outputs.size(); ++o) results.outputs[o].push_back(element.outputs[o]);
    const Words& kept = options_.scan == sk::Scan::Exclusive ? before : state;
    for (std::size_t a = 0; isScan && a < kept.size(); ++a) results.accumulators[a].push_back(kept[a]);
  }
  if (isScan) return results;
  for (const Words& state : states) {
    for (std::size_t a = 0; a < state.size(); ++a) results.accumulators[a].push_back(state[a]);
  }
  return results;
}

// ---- on a device -----------------------------------------------------------------------------------

class RandomFold::Run {
 public:
  Run(sk::Device& device, const sk::program::Reduction& compiled, const RandomFold& fold)
      : device_(device), compiled_(compiled), fold_(fold) {}

  std::string difference() {
    addUniforms();
    addInputs();
    addResults(fold_.made_.outputs, false, fold_.domain_);
    if (fold_.to_ == To::Values) return valuesDifference();
    addResults(fold_.made_.accumulators, fold_.made_.accumulatorIsRecord, fold_.resultShape());
    call();
    const Results expected = fold_.expected();
    std::vector<Words> wanted = expected.outputs;
    wanted.insert(wanted.end(), expected.accumulators.begin(), expected.accumulators.end());
    std::size_t first = 0;
    for (const Result& result : results_) {
      const std::vector<Words> parts(
          wanted.begin() + static_cast<std::ptrdiff_t>(first),
          wanted.begin() + static_cast<std::ptrdiff_t>(first + result.scalars.size()));
      first += result.scalars.size();
      Words got(static_cast<std::size_t>(result.region.shape.size()) * result.scalars.size());
      sk::detail::read(result.region, got.data(), got.size() / result.scalars.size());
      if (const std::string wrong = firstWrong(result.name, got, woven(parts), result.scalars);
          !wrong.empty())
        return wrong;
    }
    return {};
  }

 private:
  struct Result {
    std::string name;
    sk::StreamRegion region;
    std::vector<Scalar> scalars;  ///< of an element
  };

  void call() {
    switch (fold_.made_.kind) {
      case FoldKind::Scan: return sk::scan(compiled_, arguments_, fold_.options_);
      case FoldKind::Reduce: return sk::reduce(compiled_, arguments_, fold_.options_);
      case FoldKind::Kernel: return sk::fold(compiled_, arguments_, fold_.options_);
    }
  }

  std::string valuesDifference() {
    const std::vector<Words> expected = fold_.expected().accumulators;
    Words got(expected.size());
    std::vector<void*> results;
    for (std::size_t i = 0; i < got.size(); i += fold_.made_.accumulatorIsRecord ? got.size() : 1)
      results.push_back(&got[i]);
    arguments_.resize(arguments_.size() + results.size());
    sk::reduce(compiled_, arguments_, results, fold_.options_);
    return firstWrong("the values", got, woven(expected), fold_.made_.accumulators);
  }

  /// The words of several lists, element by element.
  static Words woven(const std::vector<Words>& parts) {
    Words all;
    for (std::size_t i = 0; i < parts[0].size(); ++i) {
      for (const Words& part : parts) all.push_back(part[i]);
    }
    return all;
  }

  /// A sum of nothing but -0 is -0 or 0, depending on what it starts from.
  static bool agree(std::uint32_t a, std::uint32_t b, Scalar scalar) {
    return a == b || (scalar == Scalar::Float && ((a | b) << 1) == 0);
  }

  /// `scalars` are those of an element.
  static std::string firstWrong(const std::string& name, const Words& got, const Words& expected,
                                std::span<const Scalar> scalars) {
    std::size_t word = 0;
    const auto [wrong, right] = std::ranges::mismatch(got, expected, [&](std::uint32_t a, std::uint32_t b) {
      return agree(a, b, scalars[word++ % scalars.size()]);
    });
    if (wrong == got.end() && right == expected.end()) return {};
    if (wrong == got.end() || right == expected.end())
      return fmt::format("{}: {} words, not {}\n", name, got.size(), expected.size());
    return fmt::format("{}, word {}: {:#x}, not {:#x}\n", name, wrong - got.begin(), *wrong, *right);
  }

  const sk::program::Element& nextElement() const {
    return *compiled_.fold.parameters[arguments_.size()].element;
  }

  /// A stream of the next parameter's elements that are placed as the next argument's are.
  sk::StreamRegion place(const sk::Shape& shape) {
    Untyped::element = &nextElement();
    const Placement placement = fold_.placements_[placed_++];
    if (placement == Placement::Whole || shape.size() == 0)
      return streams_.emplace_back(device_.stream<Untyped>(shape)).region();
    sk::Shape larger = shape;
    sk::Index begin = sk::Index::origin(shape.rank()), end = begin, steps = begin, offsets = begin;
    for (int d = 0; d < shape.rank(); ++d) {
      begin[d] = 1;
      end[d] = shape[d] + 1;
      steps[d] = 2 + d % 2;
      offsets[d] = steps[d] - 1;
      larger = larger.with(d, placement == Placement::Box ? shape[d] + 3 : shape[d] * steps[d]);
    }
    const sk::StreamRegion whole = streams_.emplace_back(device_.stream<Untyped>(larger)).region();
    return placement == Placement::Box ? sk::detail::partOf(whole, begin, end)
                                       : sk::detail::strided(whole, steps, offsets);
  }

  void addUniforms() {
    if (!fold_.made_.takesUniforms) return;
    arguments_.push_back({.value = &fold_.factor_});
    Untyped::element = &nextElement();
    const sk::StreamRegion table =
        streams_.emplace_back(device_.stream<Untyped>(sk::Shape(tableLength))).region();
    sk::detail::write(table, fold_.table_.data(), tableLength);
    arguments_.push_back({.region = table});
  }

  void addInputs() {
    if (fold_.to_ == To::Rows) {
      starts_.emplace(
          device_.stream<std::int32_t>(sk::Shape(static_cast<std::int64_t>(fold_.starts_.size()))));
      starts_->write(fold_.starts_);
      rows_.emplace(*starts_);
    }
    const std::size_t together = fold_.made_.inputIsRecord ? fold_.inputs_.size() : 1;
    for (std::size_t i = 0; i < fold_.inputs_.size(); i += together) {
      const sk::StreamRegion region = place(fold_.domain_);
      const Words words = woven({fold_.inputs_.begin() + static_cast<std::ptrdiff_t>(i),
                                 fold_.inputs_.begin() + static_cast<std::ptrdiff_t>(i + together)});
      sk::detail::write(region, words.data(), words.size() / together);
      sk::Argument argument{.region = region};
      if (rows_) argument.rows = (*rows_)(sk::View<Untyped>(region)).rows;
      if (inputs_++ == 0) firstInput_ = region;
      arguments_.push_back(argument);
    }
  }

  void addResults(const std::vector<Scalar>& scalars, bool areRecord, const sk::Shape& shape) {
    for (std::size_t i = 0; i < scalars.size(); i += areRecord ? scalars.size() : 1) {
      const bool isFirst = results_.empty();
      const std::string name{compiled_.fold.parameters[arguments_.size()].name};
      const sk::StreamRegion region = isFirst && fold_.isInPlace_ ? firstInput_ : place(shape);
      arguments_.push_back({.region = region});
      const auto first = scalars.begin() + static_cast<std::ptrdiff_t>(i);
      results_.push_back({name, region, {first, areRecord ? scalars.end() : first + 1}});
    }
  }

  sk::Device& device_;
  const sk::program::Reduction& compiled_;
  const RandomFold& fold_;
  std::deque<sk::Stream<Untyped>> streams_;
  std::optional<sk::Stream<std::int32_t>> starts_;
  std::optional<sk::Rows> rows_;
  std::vector<sk::Argument> arguments_;
  std::vector<Result> results_;
  sk::StreamRegion firstInput_;
  std::size_t placed_ = 0, inputs_ = 0;
};

std::string RandomFold::difference(sk::Device& device, const sk::program::Reduction& compiled) const {
  return Run(device, compiled, *this).difference();
}

}  // namespace fuzz
