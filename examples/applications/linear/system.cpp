// SPDX-License-Identifier: MIT
#include "system.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <random>
#include <stdexcept>

#include <fmt/format.h>
#include <sk/sparse_matrix.hpp>

#include "checks.hpp"
#include "compact.hpp"
#include "ordering.hpp"
#include "support/named.hpp"
#include "varying.hpp"

namespace linear {

namespace {

constexpr std::string_view gridPrefix = "poisson:";

/// "WxH" or "WxHxD", with the slowest dimension first in the shape.
sk::Shape gridOf(std::string_view text) {
  std::vector<std::int64_t> extents;
  std::string_view rest = text;
  while (true) {
    std::int64_t extent = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), extent);
    const bool isNumber = error == std::errc() && extent >= 0 && extent <= (std::int64_t{1} << 30);
    if (isNumber) extents.push_back(extent);
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    if (!isNumber || (!rest.empty() && rest.front() != 'x') || extents.size() > 3) break;
    if (rest.empty()) {
      if (extents.size() == 2) return {extents[1], extents[0]};
      if (extents.size() == 3) return {extents[2], extents[1], extents[0]};
      break;
    }
    rest.remove_prefix(1);
  }
  throw std::runtime_error(
      fmt::format("'{}{}' is no grid; write {}WxH or {}WxHxD", gridPrefix, text, gridPrefix, gridPrefix));
}

std::vector<std::string_view> split(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(at);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

/// "X,Y" or "X,Y,Z", in the order of the grid's extents.
std::vector<double> diffusivities(std::string_view text, std::string_view whole) {
  std::vector<double> diffusivity;
  for (const std::string_view part : split(text, ',')) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || end != part.data() + part.size())
      throw std::runtime_error(
          fmt::format("'{}{}' has no numbers after its grid; write one diffusivity for each dimension, as in "
                      "{}64x64:1,1000",
                      gridPrefix, whole, gridPrefix));
    diffusivity.insert(diffusivity.begin(), value);
  }
  return diffusivity;
}

Side sideNamed(std::string_view name) {
  struct Row {
    std::string_view name;
    Side side;
  };
  static constexpr Row sides[] = {
      {"dirichlet", Side::Dirichlet}, {"neumann", Side::Neumann}, {"periodic", Side::Periodic}};
  return examples::rowNamed(sides, name, "end of a grid").side;
}

/// "END" or "LOW-HIGH" for each dimension, in the order of the extents, or once for all.
std::vector<Ends> endsNamed(std::string_view text, int rank) {
  std::vector<Ends> ends;
  for (const std::string_view part : split(text, ',')) {
    const std::vector<std::string_view> names = split(part, '-');
    if (names.size() > 2)
      throw std::runtime_error(
          fmt::format("'{}' are more than two ends; write LOW-HIGH for a dimension", part));
    ends.insert(ends.begin(), {sideNamed(names.front()), sideNamed(names.back())});
  }
  if (ends.size() == 1) ends.resize(static_cast<std::size_t>(rank), ends[0]);
  return ends;
}

constexpr std::string_view filePrefix = "coefficients=";

/// The coefficients that "PATTERN=RATIO" names.
std::vector<double> patternOf(const Stencil& grid, std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string_view number = text.substr(equals + 1);
  const CoefficientPattern& pattern =
      examples::rowNamed(coefficientPatterns(), text.substr(0, equals), "pattern of coefficients");
  double ratio = 0.0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), ratio);
  if (error != std::errc() || end != number.data() + number.size() || !std::isfinite(ratio) || ratio <= 0.0)
    throw std::runtime_error(fmt::format(
        "'{}' has no ratio of coefficients above 0; write, for example, {}=1e3", text, pattern.name));
  return pattern.make(grid, ratio);
}

/// A grid, and a coefficient for each element, or none.
struct GridEquation {
  Stencil stencil;
  std::vector<double> coefficient;
  bool isCompact = false;
};

/// "GRID", and ":X,Y" or ":X,Y,Z", ":END,END" or ":END,END,END", and coefficients after it.
GridEquation equationOf(std::string_view text) {
  std::string_view file;
  if (const std::size_t at = text.find(fmt::format(":{}", filePrefix)); at != std::string_view::npos) {
    file = text.substr(at + 1 + filePrefix.size());  // which may have colons
    text = text.substr(0, at);
  }
  const std::vector<std::string_view> parts = split(text, ':');
  Stencil a = poisson(gridOf(parts[0]));
  std::string_view pattern;
  bool isCompact = false;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    if (parts[i] == "compact") {
      isCompact = true;
      continue;
    }
    if (parts[i].find('=') != std::string_view::npos) {
      pattern = parts[i];
      continue;
    }
    const bool isWord = !parts[i].empty() && std::isalpha(static_cast<unsigned char>(parts[i][0])) != 0;
    const auto before = a.ends;
    if (isWord) {
      a = withEnds(a, endsNamed(parts[i], a.grid.rank()));
    } else {
      a = poisson(a.grid, diffusivities(parts[i], text));
      a.ends = before;
    }
  }
  const bool isStored = isCompact || !file.empty() || !pattern.empty();
  const int neighbours = isCompact ? (a.grid.rank() == 2 ? 9 : 27) : 2 * a.grid.rank() + 1;
  checkGridSize(a.grid, isStored ? neighbours : 0);
  if (isCompact && (!file.empty() || !pattern.empty()))
    throw std::runtime_error("compact discretisations need constant coefficients");
  if (!file.empty()) return {a, readMatrixMarketVector(std::filesystem::path(file)), false};
  return {a, pattern.empty() ? std::vector<double>() : patternOf(a, pattern), isCompact};
}

/// From -1 to 1.
std::vector<double> uniformNoise(std::size_t n) {
  std::minstd_rand random(1);
  std::vector<double> v(n);
  for (double& x : v)
    x = 2.0 * static_cast<double>(random()) / static_cast<double>(std::minstd_rand::max()) - 1.0;
  return v;
}

}  // namespace

System::System(const std::string& matrix, const std::filesystem::path& rightHandSide) : description_(matrix) {
  if (matrix.starts_with(gridPrefix)) {
    const GridEquation equation = equationOf(std::string_view(matrix).substr(gridPrefix.size()));
    if (equation.coefficient.empty() && !equation.isCompact) {
      stencil_ = equation.stencil;
      operator_ = operatorOf(*stencil_);
    } else {
      varying_ = equation.isCompact ? compactPoisson(equation.stencil)
                                    : diffusion(equation.stencil, equation.coefficient);
      sparse_ = assemble(*varying_);
      operator_ = operatorOf(sparse_);
      operator_.varying = &*varying_;
    }
  } else {
    sparse_ = readMatrixMarket(matrix, &duplicates_);
    operator_ = operatorOf(sparse_);
  }
  const auto n = static_cast<std::size_t>(operator_.size);
  const bool isSingularGrid = operator_.isGrid() && operator_.hasConstantKernel;
  b_ = !rightHandSide.empty()
           ? readMatrixMarketVector(rightHandSide)
           : operator_.multiply(isSingularGrid ? uniformNoise(n) : std::vector<double>(n, 1.0));
}

void System::reorder(std::string_view name) {
  if (name == "none") return;
  if (operator_.isGrid())
    throw sk::Error("a grid keeps the order of its elements; --reorder is for matrices of files");
  order_ = reorderingNamed(name, sparse_);
  bandwidths_ = {.before = bandwidth(sparse_), .after = 0};
  sparse_ = permuted(sparse_, order_);
  bandwidths_->after = bandwidth(sparse_);
  operator_ = operatorOf(sparse_);
  operator_.order = order_;
  if (b_.size() == order_.size()) b_ = inOrder(b_, order_);
}

}  // namespace linear
