// SPDX-License-Identifier: MIT
#include "system.hpp"

#include <charconv>
#include <stdexcept>

#include <fmt/format.h>

#include "matrix_market.hpp"

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

/// "GRID" or "GRID:X,Y" or "GRID:X,Y,Z", with diffusivities in the order of the grid's extents.
Stencil stencilOf(std::string_view text) {
  const std::size_t colon = text.find(':');
  const sk::Shape grid = gridOf(text.substr(0, colon));
  if (colon == std::string_view::npos) return poisson(grid);
  std::vector<double> diffusivity;
  std::string_view rest = text.substr(colon + 1);
  while (true) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    if (error != std::errc() || (!rest.empty() && rest.front() != ','))
      throw std::runtime_error(
          fmt::format("'{}{}' has no numbers after its grid; write one diffusivity for each dimension, as in "
                      "{}64x64:1,1000",
                      gridPrefix, text, gridPrefix));
    diffusivity.insert(diffusivity.begin(), value);
    if (rest.empty()) return poisson(grid, diffusivity);
    rest.remove_prefix(1);
  }
}

}  // namespace

System::System(const std::string& matrix, const std::filesystem::path& rightHandSide) : description_(matrix) {
  if (matrix.starts_with(gridPrefix)) {
    stencil_ = stencilOf(std::string_view(matrix).substr(gridPrefix.size()));
    constexpr std::int64_t most = 0x7fffffff;
    if (stencil_->size() > most)
      throw std::runtime_error(fmt::format("a grid of {} elements is too large; at most {} can be solved",
                                           stencil_->size(), most));
    operator_ = operatorOf(*stencil_);
  } else {
    MarketFile file = readMarket(matrix);
    sparse_ = std::move(file.matrix);
    duplicates_ = file.duplicates;
    operator_ = operatorOf(sparse_);
  }
  const auto n = static_cast<std::size_t>(operator_.size);
  b_ = rightHandSide.empty() ? operator_.multiply(std::vector<double>(n, 1.0))
                             : readMarketVector(rightHandSide);
}

std::int64_t System::entries() const {
  if (!stencil_) return sparse_.entries();
  return stencil_->size() * (2 * stencil_->grid.rank() + 1);
}

std::unique_ptr<Matrix> System::makeMatrix(sk::Device& device, std::string_view layout,
                                           const Arithmetic& arithmetic,
                                           std::vector<LayoutTrial>* trials) const {
  const bool wantsStencil = layout == "stencil";
  if (stencil_ && (wantsStencil || layout == "auto"))
    return linear::makeMatrix(scaled(*stencil_, operator_.scale), arithmetic);
  if (wantsStencil)
    throw std::runtime_error(
        "the layout 'stencil' is for matrices of grids, as 'poisson:512x512'; a file has other layouts");
  const SparseMatrix sparse = scaled(stencil_ ? assemble(*stencil_) : sparse_, operator_.scale);
  return linear::makeMatrix(device, sparse, layout, arithmetic, trials);
}

}  // namespace linear
