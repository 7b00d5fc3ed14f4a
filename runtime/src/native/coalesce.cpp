// SPDX-License-Identifier: MIT
#include "native/coalesce.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace sk {

namespace {

using native::Extents;
using native::Operand;
using program::Parameter;
using program::Role;

/// True if nothing in the kernel depends on the dimensions of its domain.
bool isPositionIndependent(const program::Kernel& kernel, std::span<const Operand> operands) {
  if (kernel.usesIndex || kernel.usesExtent) return false;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    const bool isOfDomain = parameter.role == Role::Input || parameter.role == Role::Output;
    if (parameter.usesNear || parameter.usesIndex || (parameter.usesExtent && isOfDomain)) return false;
    if (parameter.role == Role::Iterator && !operands[i].countsElements) return false;
  }
  return true;
}

void drop(Extents& extents, std::size_t dimension, std::int64_t last) {
  std::move(extents.begin() + static_cast<std::ptrdiff_t>(dimension) + 1, extents.end(),
            extents.begin() + static_cast<std::ptrdiff_t>(dimension));
  extents.back() = last;
}
void drop(Operand& operand, std::size_t dimension) {
  drop(operand.stride, dimension, 0);
  drop(operand.extent, dimension, 1);
  drop(operand.multiply, dimension, 1);
  drop(operand.divide, dimension, 1);
}

class Coalesce {
 public:
  Coalesce(const program::Kernel& kernel, std::span<Operand> operands, Extents& domain, Extents& block,
           bool isScan)
      : kernel_(kernel), operands_(operands), domain_(domain), block_(block), isScan_(isScan) {}

  void run() {
    merge();
    if (areLinesAcrossShortRows()) turn();
  }

 private:
  void merge() {
    while (domain_[1] * domain_[2] * domain_[3] != 1) {
      if (domain_[1] == 1) {
        dropAll(1);
      } else if (domain_[0] == 1 && outputsAreDense()) {
        dropAll(0);
      } else if (areRowsInOne()) {
        mergeRows();
      } else {
        return;
      }
    }
  }

  bool isElement(std::size_t i) const {
    const Role role = kernel_.parameters[i].role;
    return (role == Role::Input || role == Role::Output || (isScan_ && role == Role::Accumulator)) &&
           !operands_[i].components.empty();
  }
  bool isResult(std::size_t i) const { return !isScan_ && kernel_.parameters[i].role == Role::Accumulator; }

  /// Drops a dimension of extent 1.
  void dropAll(std::size_t dimension) {
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      if (isElement(i) || isResult(i)) drop(operands_[i], dimension);
    }
    drop(domain_, dimension, 1);
    drop(block_, dimension, 1);
  }

  /// True if the elements of all outputs are consecutive along y.
  bool outputsAreDense() const {
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      if (isElement(i) && kernel_.parameters[i].role == Role::Output && operands_[i].stride[1] != 1)
        return false;
    }
    return true;
  }

  /// In a scan, rows become one if a block has all of them, or if each has one element of a block.
  bool areBlocksKept() const {
    const bool areWhole = block_[0] == domain_[0];
    if (!isScan_) return areWhole;
    return block_[1] == 1 ? block_[0] == 1 : areWhole && block_[1] == domain_[1];
  }

  /// True if each row directly follows the one before it in every stream, and blocks allow it.
  bool areRowsInOne() const {
    if (!areBlocksKept()) return false;
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      if (!isElement(i)) continue;
      const Operand& o = operands_[i];
      if (o.divide[0] != 1 || o.divide[1] != 1 || o.multiply[0] != o.multiply[1] || o.multiply[0] > 1)
        return false;
      if (o.multiply[0] == 1 && o.stride[1] != o.stride[0] * domain_[0]) return false;
    }
    return true;
  }
  void mergeRows() {
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      if (isElement(i)) {
        const std::int64_t extent = operands_[i].extent[0] * operands_[i].extent[1];
        drop(operands_[i], 1);
        operands_[i].extent[0] = extent;
      } else if (isResult(i)) {
        drop(operands_[i], 0);   // there is one block along x
      }
    }
    const std::int64_t width = domain_[0], blockWidth = block_[0];
    drop(domain_, 0, 1);
    drop(block_, 0, 1);
    domain_[0] *= width;
    block_[0] *= blockWidth;
  }

  /// True if blocks are lines along y, and so few of them lie side by side that folding these together gains less than
  /// long rows do.
  bool areLinesAcrossShortRows() const {
    constexpr std::int64_t few = 8, shortest = 64;
    const bool counts = std::ranges::any_of(
        kernel_.parameters, [](const Parameter& parameter) { return parameter.role == Role::Iterator; });
    return !counts && domain_[0] > 1 && domain_[0] <= few && block_[0] == 1 && block_[1] == domain_[1] &&
           block_[1] > shortest && block_[2] == 1 && block_[3] == 1;
  }
  /// Makes rows of lines along y. The blocks keep their order, because there is one along y.
  void turn() {
    const auto turned = [](Extents& extents) { std::swap(extents[0], extents[1]); };
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      if (!isElement(i) && !isResult(i)) continue;
      Operand& operand = operands_[i];
      for (Extents* extents : {&operand.stride, &operand.extent, &operand.multiply, &operand.divide})
        turned(*extents);
    }
    turned(domain_);
    turned(block_);
  }

  const program::Kernel& kernel_;
  std::span<Operand> operands_;
  Extents& domain_;
  Extents& block_;
  bool isScan_;
};

}  // namespace

void coalesce(const program::Kernel& kernel, std::span<native::Operand> operands, Extents& domain,
              Extents& block, bool isScan) {
  constexpr std::int64_t longest = std::int64_t{1} << 31;  // indices are ints
  const bool isCounted = domain[0] * domain[1] * domain[2] * domain[3] < longest;
  if (isCounted && isPositionIndependent(kernel, operands))
    Coalesce(kernel, operands, domain, block, isScan).run();
}

}  // namespace sk
