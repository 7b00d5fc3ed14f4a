// SPDX-License-Identifier: MIT
//
// Groups the calls of a pipeline into passes. A call joins the pass of the call before it unless it reads, at other elements than
// its own, what that pass writes. What only one pass uses is a variable there and no stream.
#include "frontend/lower/pipeline.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include <clang/AST/ExprCXX.h>
#include <clang/AST/StmtCXX.h>

#include "frontend/lower/function_lowering.hpp"
#include "frontend/lower/pipeline_calls.hpp"
#include "ir/build.hpp"
#include "support/namer.hpp"

namespace skc::frontend {

using clang::SourceLocation;

namespace {

using Stream = PipelineStream;
using Streams = PipelineStreams;
using Kind = PassSource::Parameter::Kind;

/// A kernel's own choices where it has made any, else the pipeline's.
ir::Choices chosen(const ir::Choices& kernel, const ir::Choices& pipeline) {
  const auto either = [](std::uint8_t own, std::uint8_t other) { return own != 0 ? own : other; };
  return {.precision = either(kernel.precision, pipeline.precision),
          .accumulate = either(kernel.accumulate, pipeline.accumulate),
          .intrinsics = either(kernel.intrinsics, pipeline.intrinsics),
          .tables = either(kernel.tables, pipeline.tables),
          .contraction = either(kernel.contraction, pipeline.contraction),
          .order = either(kernel.order, pipeline.order),
          .ahead = pipeline.ahead};
}

bool isSame(const ir::Choices& a, const ir::Choices& b) {
  return a.precision == b.precision && a.accumulate == b.accumulate && a.intrinsics == b.intrinsics &&
         a.tables == b.tables && a.contraction == b.contraction && a.order == b.order;
}

}  // namespace

class PipelineLowering {
 public:
  PipelineLowering(ModuleLowering& module, const clang::FunctionDecl* declaration, const KernelSyntax& syntax)
      : module_(module),
        definition_(declaration->getDefinition()),
        syntax_(syntax),
        calls_(module, definition_) {}

  void run() {
    makeFace();
    group();
    findStored();
    for (Pass& pass : passes_) makePass(pass);
    countBytes();
    module_.module_.pipelines.push_back(std::move(pipeline_));
  }

 private:
  struct Pass {
    std::vector<const PipelineCall*> calls;
    Streams written = {};
    ir::Choices choices = {};
    bool isAlone = false;  ///< takes no other call
    bool isOverDomain = true;
    Streams stored = {};
  };

  std::string name() const { return definition_->getNameAsString(); }

  // ---- what the pipeline is called with ---------------------------------------------------------

  void makeFace() {
    ir::Kernel& face = pipeline_.face;
    face.name = name();
    face.scope = module_.scopeOf(definition_);
    face.signature = syntax_.signature;
    face.choices = syntax_.choices;
    face.loc = module_.loc(definition_->getLocation());
    if (definition_->getPrimaryTemplate()) module_.nameInstance(definition_, face);
    PassSource whole{face.name, definition_->getLocation(), {}, {}, {}};
    for (const Bundles::Source& source : calls_.parameters())
      whole.parameters.push_back({Kind::Declared, source, nullptr, nullptr, nameOf(source, '_')});
    module_.noteGenerated(definition_);
    face.entry = addFunction(whole, /*checks=*/false);
    module_.parameters(definition_, face);
    for (const Bundles::Source& source : calls_.parameters()) {
      if (!source.member.empty()) continue;
      const ParamSyntax* declared = module_.syntax_.param(source.parameter->getLocation());
      if (declared != nullptr && !declared->attribute.empty()) {
        fail(Diag::PipelineBoundary, source.parameter->getLocation(),
             {declared->attribute, source.parameter->getNameAsString()});
      }
    }
  }

  static std::string nameOf(const Bundles::Source& source, char separator) {
    std::string name = source.parameter->getNameAsString();
    for (const clang::FieldDecl* field : source.member) name += separator + field->getNameAsString();
    return name;
  }

  // ---- passes -----------------------------------------------------------------------------------

  /// True if the call folds a domain of its own: none of its inputs has the pipeline's for sure.
  bool foldsOwnDomain(const PipelineCall& made) const {
    if (!isFold(made.syntax->kind)) return false;
    return std::ranges::none_of(made.uses, [&](const StreamUse& use) {
      return use.role == ir::ParamRole::Input && calls_.roleOf(use.stream) == ir::ParamRole::Output;
    });
  }

  /// True if an overload says how partial results of a reduce combine: as a part of a kernel it would have none.
  bool hasOwnCombine(const PipelineCall& made) const {
    if (!isFold(made.syntax->kind)) return false;
    const std::vector<std::string> scope = module_.scopeOf(made.callee);
    return std::ranges::count_if(module_.module_.kernels, [&](const ir::Kernel& kernel) {
             return kernel.name == made.callee->getNameAsString() && kernel.scope == scope &&
                    kernel.reduction;
           }) > 1;
  }

  void group() {
    for (const PipelineCall& made : calls_.list()) {
      if (!made.isLive) continue;
      const ir::Choices choices = chosen(made.syntax->choices, syntax_.choices);
      const bool ownDomain = foldsOwnDomain(made) || made.appends();
      const bool scans = made.syntax->kind == FunctionKind::Scan;
      const bool isAlone = ownDomain || scans || hasOwnCombine(made);
      const bool joins =
          !passes_.empty() && !isAlone && !passes_.back().isAlone &&
          isSame(passes_.back().choices, choices) &&
          std::ranges::none_of(made.uses, [&](const StreamUse& use) {
            return use.role == ir::ParamRole::Gather && passes_.back().written.contains(use.stream);
          });
      if (!joins) passes_.push_back({{}, {}, choices, isAlone, !isAlone, {}});
      Pass& pass = passes_.back();
      pass.calls.push_back(&made);
      for (const StreamUse& use : made.uses) {
        if (use.role == ir::ParamRole::Output) pass.written.insert(use.stream);
      }
    }
  }

  /// The streams that a pass reads as they were before it.
  static Streams readBefore(const Pass& pass) {
    Streams read, written;
    for (const PipelineCall* made : pass.calls) {
      for (const StreamUse& use : made->uses) {
        const bool isElement = use.role == ir::ParamRole::Input && !written.contains(use.stream);
        if (isElement || use.role == ir::ParamRole::Gather) read.insert(use.stream);
      }
      for (const StreamUse& use : made->uses) {
        if (use.role == ir::ParamRole::Output) written.insert(use.stream);
      }
    }
    return read;
  }

  void findStored() {
    Streams live = calls_.results();
    for (auto pass = passes_.rbegin(); pass != passes_.rend(); ++pass) {
      if (pass->calls.front()->syntax->kind == FunctionKind::Scan)
        pass->stored = pass->written;  // it is called as it is
      else
        std::ranges::set_intersection(pass->written, live, std::inserter(pass->stored, pass->stored.end()));
      for (const Stream stream : pass->written) live.erase(stream);
      live.merge(readBefore(*pass));
    }
    for (const Stream local : calls_.locals()) {
      const bool isStored =
          std::ranges::any_of(passes_, [&](const Pass& pass) { return pass.stored.contains(local); });
      if (!isStored) continue;
      localNumbers_[local] = static_cast<std::uint32_t>(pipeline_.locals.size());
      pipeline_.locals.push_back(
          {local->getNameAsString(), module_.type(local->getType(), local->getLocation())});
    }
  }

  /// The parameter of a stream in the pipeline, or its number among the local streams.
  ir::PassOperand operandOf(Stream stream) const {
    if (const auto local = localNumbers_.find(stream); local != localNumbers_.end())
      return {true, local->second};
    return {false, indexOf({llvm::cast<clang::ParmVarDecl>(stream), {}})};
  }

  std::uint32_t indexOf(const Bundles::Source& wanted) const {
    const auto found = std::ranges::find_if(calls_.parameters(), [&](const Bundles::Source& source) {
      return source.parameter == wanted.parameter && source.member == wanted.member;
    });
    return static_cast<std::uint32_t>(found - calls_.parameters().begin());
  }

  /// Values that the pass computes, in order, and the parameters that these and its calls name.
  std::set<const clang::VarDecl*> valuesOf(const Pass& pass) const {
    std::set<const clang::VarDecl*> needed;
    for (const PipelineCall* made : pass.calls) needed.insert(made->values.begin(), made->values.end());
    for (auto value = calls_.values().rbegin(); value != calls_.values().rend(); ++value) {
      if (!needed.contains(*value)) continue;
      const std::set<const clang::VarDecl*>& names = calls_.namesIn(*value);
      needed.insert(names.begin(), names.end());
    }
    return needed;
  }

  void makePass(Pass& pass) {
    const bool isOnly = passes_.size() == 1;
    inPass_ = {pass.calls.begin(), pass.calls.end()};
    if (useKernelItself(pass)) return;
    if (pass.calls.front()->syntax->kind == FunctionKind::Scan)
      fail(Diag::PipelineScan, pass.calls.front()->expr->getBeginLoc(),
           {pass.calls.front()->callee->getNameAsString()});
    PassSource source = sourceOf(pass, isOnly);
    source.name = isOnly ? pipeline_.face.name
                         : fmt::format("{}_pass{}", pipeline_.face.name, pipeline_.passes.size() + 1);
    ir::Kernel kernel;
    kernel.name = source.name;
    kernel.scope = pipeline_.face.scope;
    kernel.signature = pipeline_.face.signature;
    kernel.choices = pass.choices;
    kernel.loc = pipeline_.face.loc;
    kernel.entry = addFunction(source, /*checks=*/false);
    ir::PipelinePass made{.kernel = 0, .operands = {}, .calls = {}, .isOverDomain = pass.isOverDomain};
    for (const PassSource::Parameter& parameter : source.parameters) {
      const ir::Variable variable = module_.functionAt(kernel.entry).variables[kernel.params.size()];
      kernel.params.push_back(paramOf(parameter, variable));
      made.operands.push_back(parameter.kind == Kind::Declared
                                  ? ir::PassOperand{false, indexOf(parameter.declared)}
                                  : operandOf(parameter.stream));
    }
    const auto isRole = [&](ir::ParamRole role) {
      return std::ranges::count(kernel.params, role, &ir::KernelParam::role) > 0;
    };
    if (isRole(ir::ParamRole::Accumulator)) kernel.reduction.emplace();
    for (const PipelineCall* call : pass.calls) made.calls.push_back(call->callee->getNameAsString());
    const auto isNamedByIndex = [&](std::size_t i) {
      return !made.operands[i].isTemporary && made.operands[i].index == i;
    };
    bool isWhole =
        isOnly && isRole(ir::ParamRole::Output) && kernel.params.size() == pipeline_.face.params.size();
    for (std::size_t i = 0; i < kernel.params.size(); ++i) isWhole = isWhole && isNamedByIndex(i);
    pipeline_.isKernel = isWhole;
    kernel.isOfPipeline = !isWhole;
    if (isWhole) kernel.bundles = pipeline_.face.bundles;
    std::optional<ir::FunctionId> check;
    const bool asserts = std::ranges::any_of(pass.calls, [&](const PipelineCall* call) {
      return module_.marksOf(call->callee).assertion != nullptr;
    });
    if (asserts) check = addFunction(source, /*checks=*/true);
    made.kernel = static_cast<ir::KernelId>(module_.module_.kernels.size());
    pipeline_.passes.push_back(std::move(made));
    module_.isOwn_.push_back(true);
    module_.kernelOrigins_.push_back({nullptr, check});
    module_.module_.kernels.push_back(std::move(kernel));
  }

  /// Takes a fold or a scan of this file as it is, if its arguments are the pipeline's.
  bool useKernelItself(const Pass& pass) {
    const PipelineCall& made = *pass.calls.front();
    if (pass.calls.size() != 1 || !made.isPlain || !isFold(made.syntax->kind)) return false;
    const auto found =
        std::ranges::find_if(module_.kernelOrigins_, [&](const ModuleLowering::Origin& origin) {
          return origin.declaration != nullptr && origin.declaration->getDefinition() == made.callee;
        });
    const auto id = static_cast<ir::KernelId>(found - module_.kernelOrigins_.begin());
    if (found == module_.kernelOrigins_.end() || !module_.isOwn_[id]) return false;
    ir::PipelinePass direct{.kernel = id,
                            .operands = {},
                            .calls = {made.callee->getNameAsString()},
                            .isOverDomain = pass.isOverDomain};
    for (const Bundles::Source& source : module_.bundles_.parametersOf(made.callee)) {
      const clang::Expr* given = argumentFor(made.expr, made.callee, source.parameter);
      const auto* named = llvm::cast<clang::DeclRefExpr>(withoutCopies(given));
      direct.operands.push_back(operandOf(llvm::cast<clang::VarDecl>(named->getDecl())));
    }
    pipeline_.passes.push_back(std::move(direct));
    return true;
  }

  PassSource sourceOf(const Pass& pass, bool isOnly) {
    PassSource source{{}, definition_->getLocation(), {}, {}, {}};
    const std::set<const clang::VarDecl*> values = valuesOf(pass);
    Namer names;
    for (const Bundles::Source& parameter : calls_.parameters()) {
      const bool isStreamParameter = parameter.member.empty() && calls_.isStream(parameter.parameter);
      if (!isStreamParameter) {
        if (isOnly || values.contains(parameter.parameter))
          source.parameters.push_back(
              {Kind::Declared, parameter, nullptr, nullptr, names.take(nameOf(parameter, '_'))});
        continue;
      }
      const std::size_t before = source.parameters.size();
      streamParameters(pass, parameter.parameter, names, source);
      if (isOnly && source.parameters.size() == before)  // C++ passes it all the same
        source.parameters.push_back(
            {Kind::Declared, parameter, nullptr, nullptr, names.take(nameOf(parameter, '_'))});
    }
    for (const Stream local : calls_.locals()) streamParameters(pass, local, names, source);
    const auto addUnstored = [&](Stream stream) {
      if (pass.written.contains(stream) && !pass.stored.contains(stream)) source.unstored.push_back(stream);
    };
    for (const Bundles::Source& parameter : calls_.parameters()) {
      if (parameter.member.empty()) addUnstored(parameter.parameter);
    }
    for (const Stream local : calls_.locals()) addUnstored(local);
    for (const clang::VarDecl* value : calls_.values()) {
      if (values.contains(value)) source.steps.push_back({value, nullptr});
    }
    for (const PipelineCall* made : pass.calls) source.steps.push_back({nullptr, made->expr});
    return source;
  }

  void streamParameters(const Pass& pass, Stream stream, Namer& names, PassSource& source) {
    const ir::ParamRole role = calls_.roleOf(stream);
    const bool isElement = role == ir::ParamRole::Input || role == ir::ParamRole::Output;
    if (!isElement && role != ir::ParamRole::Gather) {  // folded or appended
      const bool isUsed = std::ranges::any_of(pass.calls, [&](const PipelineCall* made) {
        return std::ranges::count(made->uses, stream, &StreamUse::stream) > 0;
      });
      const Bundles::Source declared{llvm::cast<clang::ParmVarDecl>(stream), {}};
      if (isUsed)
        source.parameters.push_back(
            {Kind::Declared, declared, nullptr, nullptr, names.take(stream->getNameAsString())});
      return;
    }
    const auto add = [&](Kind kind, const clang::ParmVarDecl* reader) {
      source.parameters.push_back({kind, {}, stream, reader, names.take(stream->getNameAsString())});
    };
    if (pass.stored.contains(stream)) add(Kind::Output, nullptr);
    if (readsElement(pass, stream)) add(Kind::Input, nullptr);
    std::set<const clang::ParmVarDecl*> readers;
    for (const PipelineCall* made : pass.calls) {
      for (const StreamUse& use : made->uses) {
        if (use.stream == stream && use.role == ir::ParamRole::Gather && readers.insert(use.parameter).second)
          add(Kind::Gather, use.parameter);
      }
    }
  }

  /// True if the pass reads the element that the stream had before.
  static bool readsElement(const Pass& pass, Stream stream) {
    for (const PipelineCall* made : pass.calls) {
      if (made->hasUse(stream, ir::ParamRole::Input)) return true;
      if (made->hasUse(stream, ir::ParamRole::Output)) return false;
    }
    return false;
  }

  ir::KernelParam paramOf(const PassSource::Parameter& parameter, const ir::Variable& variable) {
    if (parameter.kind == Kind::Declared)
      return ir::clone(pipeline_.face.params[indexOf(parameter.declared)]);
    if (parameter.kind == Kind::Gather) {
      const auto* kernel = llvm::cast<clang::FunctionDecl>(parameter.reader->getDeclContext());
      module_.noteGenerated(kernel);
      ir::KernelParam gather = module_.kernelParam(parameter.reader, parameter.name, variable);
      module_.noteGenerated(definition_);
      return gather;
    }
    ir::KernelParam param;
    param.range = rangeOf(parameter);
    const bool isGiven = llvm::isa<clang::ParmVarDecl>(parameter.stream);
    if (isGiven) {
      const std::optional<ir::ValueRange> range = param.range;
      param = ir::clone(pipeline_.face.params[operandOf(parameter.stream).index]);
      if (!param.range) param.range = range;
    }
    param.name = parameter.name;
    param.role = parameter.kind == Kind::Input ? ir::ParamRole::Input : ir::ParamRole::Output;
    param.type = variable.type;
    param.loc = variable.loc;
    return param;
  }

  /// What the first kernel that reads an input of the pass promises of it.
  std::optional<ir::ValueRange> rangeOf(const PassSource::Parameter& parameter) {
    if (parameter.kind != Kind::Input) return std::nullopt;
    for (const PipelineCall& made : calls_.list()) {
      for (const StreamUse& use : made.uses) {
        if (use.stream != parameter.stream || use.role != ir::ParamRole::Input || !inPass_.contains(&made))
          continue;
        const ParamSyntax* syntax = module_.syntax_.param(use.parameter->getLocation());
        const bool isSame = module_.context().hasSameUnqualifiedType(
            use.parameter->getType().getNonReferenceType(), use.stream->getType().getNonReferenceType());
        if (!isSame || syntax == nullptr || !syntax->range) return std::nullopt;
        module_.noteGenerated(made.callee);
        ir::Variable variable;
        variable.type = module_.type(use.parameter->getType().getNonReferenceType().getUnqualifiedType(),
                                     use.parameter->getLocation());
        const std::optional<ir::ValueRange> range =
            module_.kernelParam(use.parameter, parameter.name, variable).range;
        module_.noteGenerated(definition_);
        return range;
      }
    }
    return std::nullopt;
  }

  ir::FunctionId addFunction(const PassSource& source, bool checks) {
    FunctionLowering lowering(module_, checks);
    ir::Function function = lowering.pass(source);
    const auto id = static_cast<ir::FunctionId>(module_.module_.functions.size());
    module_.module_.functions.push_back(std::move(function));
    return id;
  }

  // ---- what it saves ----------------------------------------------------------------------------

  std::uint64_t bytesOf(const Streams& streams) const {
    std::uint64_t bytes = 0;
    for (const Stream stream : streams) {
      ir::Type element;
      const clang::QualType type = stream->getType().getNonReferenceType();
      if (module_.gatherRank(type, stream->getLocation(), element) == 0)
        element = module_.type(type, stream->getLocation());
      bytes += ir::memoryBytes(module_.module_, element);
    }
    return bytes;
  }

  void countBytes() {
    for (const Pass& pass : passes_) {
      pipeline_.bytesOfPasses += bytesOf(readBefore(pass)) + bytesOf(pass.stored);
      for (const PipelineCall* made : pass.calls) {
        Pass alone{.calls = {made}};
        for (const StreamUse& use : made->uses) {
          if (use.role == ir::ParamRole::Output) alone.written.insert(use.stream);
        }
        pipeline_.bytesOfCalls += bytesOf(readBefore(alone)) + bytesOf(alone.written);
      }
    }
  }

  [[noreturn]] void fail(Diag diag, SourceLocation where, std::initializer_list<std::string_view> arguments) {
    module_.fail(diag, where, arguments);
  }

  ModuleLowering& module_;
  const clang::FunctionDecl* definition_;
  const KernelSyntax& syntax_;
  ir::Pipeline pipeline_;
  const PipelineCalls calls_;
  std::vector<Pass> passes_;
  std::set<const PipelineCall*> inPass_;  ///< the calls of the pass that is made
  std::map<Stream, std::uint32_t> localNumbers_;
};

void lowerPipeline(ModuleLowering& module, const clang::FunctionDecl* declaration,
                   const KernelSyntax& syntax) {
  PipelineLowering(module, declaration, syntax).run();
}

}  // namespace skc::frontend
