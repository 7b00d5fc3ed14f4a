// SPDX-License-Identifier: MIT
#include "split/bundles.hpp"

#include <algorithm>
#include <cassert>
#include <optional>

#include "split/cost.hpp"
#include "split/demand.hpp"

namespace skc::split {
namespace {

using namespace ir;

/// A vector of three takes a texel of four. (No plane is a vector of doubles.)
Type texelType(Type plane) { return plane.width == 3 ? Type::of(plane.scalar, 4) : plane; }

struct ReadPlane {
  ArgumentPlane place;
  Type type;
};

class Chooser {
 public:
  Chooser(const Module& module, const Kernel& kernel) : module_(module), kernel_(kernel) {}

  std::vector<Bundle> run(const std::vector<PassReads>& passes, std::uint32_t units) {
    for (const PassReads& pass : passes) {
      while (unitsOf(pass) > units) bundleOne(pass);
    }
    return std::move(bundles_);
  }

 private:
  std::vector<ReadPlane> planesRead(const PassReads& pass) const {
    std::vector<ReadPlane> planes;
    for (std::uint32_t i = 0; i < kernel_.params.size(); ++i) {
      if (!pass.params[i] || !isRead(kernel_.params[i])) continue;
      const std::vector<Type> types = planesOf(module_, heldType(kernel_.params[i]));
      for (std::uint32_t plane = 0; plane < types.size(); ++plane) {
        planes.push_back({{i, plane}, texelType(types[plane])});
      }
    }
    return planes;
  }

  Bundle* bundleOf(const ArgumentPlane& place) {
    const auto holds = [&](const Bundle& bundle) {
      return std::ranges::find(bundle.layers, place) != bundle.layers.end();
    };
    const auto found = std::ranges::find_if(bundles_, holds);
    return found == bundles_.end() ? nullptr : &*found;
  }

  std::uint32_t unitsOf(const PassReads& pass) {
    std::uint32_t units = pass.temporaries;
    std::vector<const Bundle*> counted;
    for (const ReadPlane& plane : planesRead(pass)) {
      const Bundle* bundle = bundleOf(plane.place);
      if (bundle != nullptr && std::ranges::find(counted, bundle) != counted.end()) continue;
      if (bundle != nullptr) counted.push_back(bundle);
      ++units;
    }
    return units;
  }

  /// Adds one more plane of the pass to a bundle: to an existing one, since that frees a unit, or else to a
  /// new one in the format that most planes have.
  void bundleOne(const PassReads& pass) {
    std::vector<ReadPlane> free = planesRead(pass);
    std::erase_if(free, [&](const ReadPlane& plane) { return bundleOf(plane.place) != nullptr; });
    assert(!free.empty() && "there are fewer formats than texture units");
    for (const ReadPlane& plane : free) {
      const auto bundle = std::ranges::find(bundles_, plane.type, &Bundle::type);
      if (bundle == bundles_.end()) continue;
      bundle->layers.push_back(plane.place);
      return;
    }
    const auto countOf = [&](const ReadPlane& one) {
      return std::ranges::count(free, one.type, &ReadPlane::type);
    };
    const ReadPlane most = *std::ranges::max_element(free, {}, countOf);
    bundles_.push_back({most.type, {most.place}});
  }

  const Module& module_;
  const Kernel& kernel_;
  std::vector<Bundle> bundles_;
};

}  // namespace

std::vector<Bundle> chooseBundles(const Module& module, const Kernel& kernel,
                                  const std::vector<PassReads>& passes, std::uint32_t units) {
  return Chooser(module, kernel).run(passes, units);
}

}  // namespace skc::split
