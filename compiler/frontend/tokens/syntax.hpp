// SPDX-License-Identifier: MIT
//
// What the token editor learned from Brook's declarations and Clang does not know: which functions are
// kernels, and how each parameter was declared. Keyed by the location of the name's token, which is also the
// location of the FunctionDecl or ParmVarDecl.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <clang/Basic/SourceLocation.h>

#include "ir/ir.hpp"

namespace clang {
class IdentifierInfo;
}

namespace skc::frontend {

enum class FunctionKind : std::uint8_t { Kernel, Reduce, Scan, Pipeline, Helper };

/// Whether it folds elements into accumulators.
constexpr bool isFold(FunctionKind kind) {
  return kind == FunctionKind::Reduce || kind == FunctionKind::Scan;
}
/// The word that declares it, and, for a fold, its accumulators.
constexpr std::string_view wordOf(FunctionKind kind) {
  switch (kind) {
    case FunctionKind::Kernel: return "kernel";
    case FunctionKind::Reduce: return "reduce";
    case FunctionKind::Scan: return "scan";
    case FunctionKind::Pipeline: return "pipeline";
    case FunctionKind::Helper: break;
  }
  return "function";
}

struct KernelSyntax {
  FunctionKind kind = FunctionKind::Kernel;
  clang::SourceLocation keyword;     ///< of `kernel`, `reduce`, `scan` or `pipeline`
  ir::Choices choices;
  std::string signature;             ///< the declaration on one line, as written
};

/// [[range(lo, hi)]]: the generated constants that hold the ends.
struct RangeSyntax {
  std::string low, high;
};

struct ParamSyntax {
  ir::ParamRole role = ir::ParamRole::Uniform;
  std::uint8_t rank = 0;
  ir::Boundary boundary = ir::Boundary::Clamp;
  bool filter = false;
  std::string attribute;             ///< the last word in [[...]]
  std::vector<std::int32_t> halo;    ///< the numbers of [[halo(...)]], x first
  std::string border;                ///< name of the generated constant that holds [[border(v)]]
  std::string identity;              ///< name of the generated constant that holds `= identity`
  std::optional<RangeSyntax> range;
};

/// An extent of a `stream` declaration: a name, or the generated constant that holds the extent.
struct ExtentSyntax {
  clang::SourceLocation location;
  const clang::IdentifierInfo* name = nullptr;
  std::string constant;
};

struct StreamSyntax {
  std::vector<ExtentSyntax> extents;   ///< slowest first
};

/// [[table(lo, hi, n, linear)]] in front of a function: the generated constants that hold the arguments.
struct TableSyntax {
  std::string low, high, intervals;
  bool isCubic = false;
};

class DeclarationSyntax {
 public:
  void add(clang::SourceLocation name, KernelSyntax kernel) {
    kernels_[name.getRawEncoding()] = std::move(kernel);
  }
  void add(clang::SourceLocation name, ParamSyntax param) {
    params_[name.getRawEncoding()] = std::move(param);
  }

  void add(clang::SourceLocation name, StreamSyntax stream) {
    streams_[name.getRawEncoding()] = std::move(stream);
  }

  void add(clang::SourceLocation name, TableSyntax table) {
    tables_[name.getRawEncoding()] = std::move(table);
  }

  /// `name`: any token before the parameters of `template kernel void f<float>(...);`.
  void addInstantiation(clang::SourceLocation name) { instantiations_.insert(name.getRawEncoding()); }
  bool isInstantiation(clang::SourceLocation name) const {
    return instantiations_.contains(name.getRawEncoding());
  }

  /// `name`: of a stream that a pipeline declares: `float t<>;`
  void addLocalStream(clang::SourceLocation name) { localStreams_.insert(name.getRawEncoding()); }
  bool isLocalStream(clang::SourceLocation name) const {
    return localStreams_.contains(name.getRawEncoding());
  }

  const KernelSyntax* kernel(clang::SourceLocation name) const { return find(kernels_, name); }
  const StreamSyntax* stream(clang::SourceLocation name) const { return find(streams_, name); }
  const TableSyntax* table(clang::SourceLocation name) const { return find(tables_, name); }
  const ParamSyntax* param(clang::SourceLocation name) const { return find(params_, name); }
  /// Calls visit(location of the name, parameter) for all parameters, in any order.
  template <class Visit>
  void forEachParam(Visit&& visit) const {
    for (const auto& [name, param] : params_) visit(clang::SourceLocation::getFromRawEncoding(name), param);
  }

 private:
  template <class Map>
  static const typename Map::mapped_type* find(const Map& map, clang::SourceLocation name) {
    const auto found = map.find(name.getRawEncoding());
    return found == map.end() ? nullptr : &found->second;
  }

  std::unordered_map<std::uint32_t, KernelSyntax> kernels_;
  std::unordered_map<std::uint32_t, ParamSyntax> params_;
  std::unordered_map<std::uint32_t, StreamSyntax> streams_;
  std::unordered_map<std::uint32_t, TableSyntax> tables_;
  std::unordered_set<std::uint32_t> instantiations_, localStreams_;
};

}  // namespace skc::frontend
