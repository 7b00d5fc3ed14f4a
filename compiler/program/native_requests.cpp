// SPDX-License-Identifier: MIT
#include "program/native_requests.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "program/constants.hpp"
#include "support/text.hpp"

namespace skc::emit {

using namespace ir;

class RequestBuilder {
 public:
  RequestBuilder(const Module& module, NativeRequests& requests, std::string prefix, bool inQuads)
      : module_(module), requests_(requests), prefix_(std::move(prefix)), inQuads_(inQuads) {}

  void addTable(KernelId values, const std::string& name) { add(values, name, inAnyReal(Speed::Any)); }

  void addUnit(KernelId id, const std::string& name) {
    const Kernel& kernel = module_.kernels[id];
    scans_ = kernel.isScan;
    add(id, name, inAnyReal(Speed::Best));
    for (const UnrolledVariant& variant : kernel.unrolled)
      add(variant.kernel, numbered(name, Part::Unrolled, variant.value), inFloats(Speed::Best));
    if (kernel.assertions) {
      const Kernel& check = module_.kernels[kernel.assertions->check];
      const std::string checkName = name + Part::Check;
      add(kernel.assertions->check, checkName, inAnyReal(Speed::Any));
      if (check.variants.half) add(*check.variants.half, checkName + Part::Half, inFloats(Speed::Any));
    }
    if (!kernel.reduction) {
      if (kernel.variants.half) add(*kernel.variants.half, name + Part::Half, inFloats(Speed::Any));
      return;
    }
    const Reduction& reduction = *kernel.reduction;
    const KernelId combine = *reduction.combine;
    if (!isUnit(module_.kernels[combine]))  // an overload has code of its own
      add(combine, name + Part::Combine, combining(inAnyReal(Speed::Best)));
    if (reduction.compensated) addCompensated(kernel, name);
    if (kernel.variants.half) addReduction(*kernel.variants.half, name + Part::Half, inFloats(Speed::Any));
    for (std::size_t i = 0; i < reduction.exact.size(); ++i)
      addExact(kernel, reduction.exact[i], name + Part::Exact, i);
    if (kernel.parts) addParts(*kernel.parts, name);
  }

 private:
  /// How much the speed of a kernel's native code matters.
  enum class Speed : std::uint8_t {
    Any,  ///< little: it computes a few elements, or what another device would compute
    Best,
  };

  /// For kernels that compute in any real type. add() sets kernel and symbol.
  native::KernelRequest inAnyReal(Speed speed) const {
    native::KernelRequest request = inFloats(speed);
    request.inDoubles = true;
    request.inQuads = inQuads_;
    return request;
  }
  /// For kernels that compute in float only.
  native::KernelRequest inFloats(Speed speed) const {
    return {.kernel = {}, .symbol = {}, .scans = scans_, .isCold = speed == Speed::Any};
  }
  /// For reduces that only combine partial results, and that no call runs.
  static native::KernelRequest combining(native::KernelRequest request) {
    request.onlyCombines = true;
    return request;
  }

  void addReduction(KernelId id, const std::string& name, const native::KernelRequest& request) {
    add(id, name, request);
    add(*module_.kernels[id].reduction->combine, name + Part::Combine, combining(request));
  }

  void addCompensated(const Kernel& kernel, const std::string& name) {
    const Compensated& sum = *kernel.reduction->compensated;
    const bool seldomRuns =
        !sum.term.empty() || (kernel.parts && kernel.parts->inDoubles);  // doubles do instead
    const native::KernelRequest request = inAnyReal(seldomRuns ? Speed::Any : Speed::Best);
    const std::string prefix = name + Part::Compensated;
    add(sum.fold, prefix + Part::Fold, request);
    add(*module_.kernels[sum.fold].reduction->combine, prefix + Part::Combine, combining(request));
    add(sum.finish, name + Part::Finish, inAnyReal(Speed::Any));
  }

  /// Digits are folded natively only in scans, and without a term. The reference device adds the doubles of terms.
  void addExact(const Kernel& kernel, const ExactSum& sum, const std::string& name, std::size_t number) {
    if (sum.term.isEmpty() || kernel.isScan) {
      const KernelId combine = *module_.kernels[sum.fold].reduction->combine;
      add(sum.fold, numbered(name, Part::Fold, number), inFloats(Speed::Any));
      add(combine, exactCombinationName(module_.kernels[combine]), combining(inFloats(Speed::Any)));
      add(sum.finish, numbered(name, Part::Finish, number), inFloats(Speed::Any));
    }
    if (sum.term.kernel) add(*sum.term.kernel, numbered(name, Part::Term, number), inAnyReal(Speed::Any));
  }

  /// The reduce that reads outputs has no native code, since native code folds beside the outputs.
  void addParts(const FoldParts& parts, const std::string& name) {
    const Kernel& map = module_.kernels[parts.map];
    const std::string mapName = name + Part::Map, doublesName = name + Part::InDoubles;
    if (map.variants.half) add(*map.variants.half, mapName + Part::Half, inFloats(Speed::Any));
    add(parts.map, mapName, inAnyReal(Speed::Any));
    if (!parts.inDoubles) return;
    addReduction(*parts.inDoubles, doublesName, inFloats(Speed::Best));
    add(*module_.kernels[*parts.inDoubles].reduction->finish, doublesName + Part::Finish,
        inFloats(Speed::Any));
  }

  /// Several sums share what combines their digits, and a fold may combine itself: the first request counts.
  void add(KernelId kernel, const std::string& name, native::KernelRequest request) {
    if (!requests_.byKernel_.emplace(kernel, requests_.requests_.size()).second) return;
    request.kernel = kernel;
    request.symbol = prefix_ + name;
    requests_.requests_.push_back(std::move(request));
  }

  const Module& module_;
  NativeRequests& requests_;
  const std::string prefix_;
  const bool inQuads_;
  bool scans_ = false;  ///< the unit is a scan
};

NativeRequests::NativeRequests(const Module& module, const Program& program,
                               const std::vector<std::string>& names, std::string_view header, bool inQuads) {
  RequestBuilder builder(module, *this, fmt::format("sk_{:016x}_", textHash(header)), inQuads);
  const std::vector<std::string> tables = tableNames(module);
  for (TableId id = 0; id < module.tables.size(); ++id)
    if (module.tables[id].kernel) builder.addTable(*module.tables[id].kernel, tables[id]);
  for (std::size_t i = 0; i < names.size(); ++i) builder.addUnit(program.units()[i].id, names[i]);
}

std::string_view NativeRequests::symbolOf(KernelId kernel) const {
  const auto known = byKernel_.find(kernel);
  return known == byKernel_.end() ? std::string_view() : requests_[known->second].symbol;
}

}  // namespace skc::emit
