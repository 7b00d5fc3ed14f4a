// SPDX-License-Identifier: MIT
#include "operator_matrix.hpp"

#include <fmt/format.h>

namespace sk::linear {

std::int64_t entriesOf(const Operator& a) {
  if (a.sparse != nullptr) return a.sparse->entries();
  return a.stencil->size() * (2 * a.stencil->grid.rank() + 1);
}

sk::Shape shapeOf(const Operator& a) {
  if (a.stencil) return a.stencil->grid;
  return a.varying != nullptr ? a.varying->grid : sk::Shape{a.size};
}

std::int64_t matrixBytes(const Operator& a, std::string_view layout, std::int64_t entryBytes) {
  const bool isOfGrid = layout == "stencil" || (a.isGrid() && layout == "auto");
  if (isOfGrid)
    return a.varying != nullptr ? entryBytes * static_cast<std::int64_t>(a.varying->value.size()) : 0;
  return bytesOf(a.stencil ? assemble(*a.stencil) : *a.sparse, layout, entryBytes);
}

std::unique_ptr<Matrix> makeMatrix(const Space& space, const Operator& a, std::string_view layout,
                                   const Arithmetic& arithmetic, std::vector<LayoutCost>* costs) {
  if (layout == "stencil" || layout == "auto") {
    if (a.stencil) return makeMatrix(space, scaled(*a.stencil, a.scale), arithmetic);
    if (a.varying != nullptr) return makeMatrix(space, scaled(*a.varying, a.scale), arithmetic);
  }
  if (layout == "stencil")
    throw sk::Error(
        "the layout 'stencil' is for matrices of grids, as 'poisson:512x512'; a file has other layouts");
  if (space.isDivided())
    throw sk::Error(
        fmt::format("the layout '{}' is for one process, because rows read any element of a vector; take the "
                    "layout 'stencil' for a grid, or start it without mpirun",
                    layout));
  return makeMatrix(space.device(), scaled(sparseOf(a), a.scale), layout, arithmetic, costs);
}

}  // namespace sk::linear
