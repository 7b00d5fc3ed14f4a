// SPDX-License-Identifier: MIT
#include "bvh.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace rays {
namespace {

constexpr int steps = 255;
/// Kernels compute distances from bytes, with an error below this part of a node's 255 steps.
constexpr double room = 0x1p-20;
constexpr std::int32_t nothing = -8;

using Children = std::array<std::int64_t, wideChildren>;  // nodes of the binary tree, or -1

double coordinate(const sk::float3& v, std::size_t axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// A dimension of a node's boxes: coordinate = origin + byte * step.
struct Axis {
  float origin = 0.0f;
  int exponent = 0;  ///< of the step

  double step() const { return std::ldexp(1.0, exponent); }
  double margin() const { return room * steps * step(); }
  int lowByte(double x) const { return int(std::floor((x - margin() - origin) / step())); }
  int highByte(double x) const { return int(std::ceil((x + margin() - origin) / step())); }
};

/// The finest steps with which all from `low` to `high` fits into bytes.
Axis axisOf(double low, double high) {
  for (int exponent = std::ilogb((high - low) / steps);; ++exponent) {
    Axis axis{0.0f, exponent};
    axis.origin = std::nextafter(static_cast<float>(low - axis.margin()), -HUGE_VALF);
    if (axis.highByte(high) <= steps) return axis;
  }
}

class Widener {
 public:
  explicit Widener(const Bvh& bvh) : bvh_(bvh) {}

  WideBvh widened() {
    if (bvh_.nodes.empty()) return {};
    Children alone;
    alone.fill(-1);
    alone[0] = 0;
    append();
    fill(0, bvh_.nodes[0].count > 0 ? alone : childrenOf(0));
    return std::move(wide_);
  }

 private:
  std::size_t append() {
    const std::size_t at = wide_.size();
    if (at >= mostWideNodes)
      throw std::runtime_error(
          fmt::format("there are more than {} nodes of eight children; choose nodes = 2", mostWideNodes));
    wide_.nodes.resize(wide_.nodes.size() + 4);
    wide_.children.resize(wide_.children.size() + wideChildren, nothing);
    return at;
  }

  const BvhNode& node(std::int64_t i) const { return bvh_.nodes[static_cast<std::size_t>(i)]; }

  Children childrenOf(std::int64_t at) const {
    Children open;
    open.fill(-1);
    open[0] = node(at).first;
    open[1] = node(at).first + 1;
    for (std::size_t count = 2; count < wideChildren; ++count) {
      std::size_t largest = count;
      for (std::size_t i = 0; i < count; ++i) {
        if (node(open[i]).count == 0 &&
            (largest == count || node(open[i]).bounds.halfArea() > node(open[largest]).bounds.halfArea()))
          largest = i;
      }
      if (largest == count) break;
      const std::int64_t first = node(open[largest]).first;
      open[largest] = first;
      open[count] = first + 1;
    }
    return open;
  }

  /// Gives each child the free slot that its centre lies farthest in the direction of, those first that care most.
  Children placed(const Children& children, const Bounds& bounds) const {
    Children slots;
    slots.fill(-1);
    Children waiting = children;
    const auto preference = [&](std::int64_t child, std::size_t slot) {
      double sum = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Bounds& b = node(child).bounds;
        const double aside = coordinate(b.least, axis) + coordinate(b.most, axis) -
                             coordinate(bounds.least, axis) - coordinate(bounds.most, axis);
        sum += slot >> axis & 1 ? aside : -aside;
      }
      return sum;
    };
    for (;;) {
      std::size_t best = wideChildren, bestSlot = 0;
      double most = -HUGE_VAL;
      for (std::size_t i = 0; i < wideChildren; ++i) {
        for (std::size_t slot = 0; slot < wideChildren && waiting[i] >= 0; ++slot) {
          if (slots[slot] >= 0) continue;
          const double here = preference(waiting[i], slot);
          if (here > most) most = here, best = i, bestSlot = slot;
        }
      }
      if (best == wideChildren) return slots;
      slots[bestSlot] = waiting[best];
      waiting[best] = -1;
    }
  }

  void fill(std::size_t at, const Children& children) {
    Bounds bounds;
    for (const std::int64_t child : children)
      if (child >= 0) bounds.grow(node(child).bounds);
    const Children slots = placed(children, bounds);
    // Rows: low x, low y, low z, high x, high y, high z. Where there is no child, the low is above the high.
    std::array<std::array<std::uint8_t, wideChildren>, 6> bytes{};
    std::array<std::uint32_t, 4> head{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Axis axis = axisOf(coordinate(bounds.least, k), coordinate(bounds.most, k));
      head[k] = std::bit_cast<std::uint32_t>(axis.origin);
      head[3] |= static_cast<std::uint32_t>(axis.exponent + 127) << (8 * k);
      for (std::size_t slot = 0; slot < wideChildren; ++slot) {
        const bool isThere = slots[slot] >= 0;
        const Bounds& b = node(std::max<std::int64_t>(slots[slot], 0)).bounds;
        bytes[k][slot] = static_cast<std::uint8_t>(isThere ? axis.lowByte(coordinate(b.least, k)) : steps);
        bytes[3 + k][slot] = static_cast<std::uint8_t>(isThere ? axis.highByte(coordinate(b.most, k)) : 0);
      }
    }
    store(at, head, bytes);
    for (std::size_t slot = 0; slot < wideChildren; ++slot) {
      if (slots[slot] < 0) continue;
      const BvhNode& child = node(slots[slot]);
      std::int64_t number = -(std::int64_t{8} * child.first + child.count);
      if (child.count == 0) {
        const std::size_t below = append();
        number = static_cast<std::int64_t>(below);
        fill(below, childrenOf(slots[slot]));
      }
      wide_.children[wideChildren * at + slot] = static_cast<std::int32_t>(number);
    }
  }

  void store(std::size_t at, const std::array<std::uint32_t, 4>& head,
             const std::array<std::array<std::uint8_t, wideChildren>, 6>& bytes) {
    const auto word = [](std::uint32_t bits) { return static_cast<std::int32_t>(bits); };
    const auto four = [&](std::size_t row, std::size_t first) {
      std::uint32_t bits = 0;
      for (std::size_t i = 0; i < 4; ++i) bits |= std::uint32_t{bytes[row][first + i]} << (8 * i);
      return word(bits);
    };
    wide_.nodes[4 * at] = {word(head[0]), word(head[1]), word(head[2]), word(head[3])};
    for (std::size_t i = 0; i < 3; ++i)
      wide_.nodes[4 * at + 1 + i] = {four(2 * i, 0), four(2 * i, 4), four(2 * i + 1, 0), four(2 * i + 1, 4)};
  }

  const Bvh& bvh_;
  WideBvh wide_;
};

}  // namespace

WideBvh widen(const Bvh& bvh) { return Widener(bvh).widened(); }

}  // namespace rays
