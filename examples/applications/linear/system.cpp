// SPDX-License-Identifier: MIT
#include "system.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <random>
#include <stdexcept>

#include <fmt/format.h>

#include "compact.hpp"
#include "matrix_market.hpp"
#include "support/host_memory.hpp"
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

/// `entries` of a row are stored, in coordinates, compressed rows and by the grid; none of a stencil.
void checkSize(const Stencil& a, int entries) {
  constexpr std::int64_t most = 0x7fffffff;
  if (a.size() > most)
    throw std::runtime_error(
        fmt::format("a grid of {} elements is too large; at most {} can be solved", a.size(), most));
  constexpr int vectors =
      6;  // the diagonal, squares of rows, sums, the right-hand side, and two while it is scaled
  examples::requireMemory(fmt::format("a grid of {} elements", a.size()),
                          (8.0 * vectors + 56.0 * entries) * static_cast<double>(a.size()));
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
  checkSize(a, isStored ? neighbours : 0);
  if (isCompact && (!file.empty() || !pattern.empty()))
    throw std::runtime_error("compact discretisations need constant coefficients");
  if (!file.empty()) return {a, readMarketVector(std::filesystem::path(file)), false};
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
    MarketFile file = readMarket(matrix);
    sparse_ = std::move(file.matrix);
    duplicates_ = file.duplicates;
    operator_ = operatorOf(sparse_);
  }
  const auto n = static_cast<std::size_t>(operator_.size);
  const bool isSingularGrid = operator_.isGrid() && operator_.hasConstantKernel;
  b_ = !rightHandSide.empty()
           ? readMarketVector(rightHandSide)
           : operator_.multiply(isSingularGrid ? uniformNoise(n) : std::vector<double>(n, 1.0));
}

std::int64_t System::entries() const {
  if (!stencil_) return sparse_.entries();
  return stencil_->size() * (2 * stencil_->grid.rank() + 1);
}

std::int64_t System::matrixBytes(std::string_view layout, std::int64_t entryBytes) const {
  const bool isOfGrid = layout == "stencil" || (operator_.isGrid() && layout == "auto");
  if (isOfGrid) return varying_ ? entryBytes * static_cast<std::int64_t>(varying_->value.size()) : 0;
  return bytesOf(stencil_ ? assemble(*stencil_) : sparse_, layout, entryBytes);
}

sk::Shape System::shape() const {
  if (stencil_) return stencil_->grid;
  return varying_ ? varying_->grid : sk::Shape{operator_.size};
}

std::unique_ptr<Matrix> System::makeMatrix(sk::Device& device, std::string_view layout,
                                           const Arithmetic& arithmetic,
                                           std::vector<LayoutCost>* costs) const {
  return makeMatrix(Space(device, shape()), layout, arithmetic, costs);
}

std::unique_ptr<Matrix> System::makeMatrix(const Space& space, std::string_view layout,
                                           const Arithmetic& arithmetic,
                                           std::vector<LayoutCost>* costs) const {
  const bool wantsStencil = layout == "stencil";
  if (stencil_ && (wantsStencil || layout == "auto"))
    return linear::makeMatrix(space, scaled(*stencil_, operator_.scale), arithmetic);
  if (varying_ && (wantsStencil || layout == "auto"))
    return linear::makeMatrix(space, scaled(*varying_, operator_.scale), arithmetic);
  if (wantsStencil)
    throw std::runtime_error(
        "the layout 'stencil' is for matrices of grids, as 'poisson:512x512'; a file has other layouts");
  if (space.isDivided())
    throw std::runtime_error(
        fmt::format("the layout '{}' is for one process, because rows read any element of a vector; take "
                    "--layout stencil for "
                    "a grid, or start it without mpirun",
                    layout));
  const SparseMatrix sparse = scaled(stencil_ ? assemble(*stencil_) : sparse_, operator_.scale);
  return linear::makeMatrix(space.device(), sparse, layout, arithmetic, costs);
}

}  // namespace linear
