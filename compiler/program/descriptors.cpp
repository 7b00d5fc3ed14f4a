// SPDX-License-Identifier: MIT
#include "program/descriptors.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/iterations.hpp"
#include "analysis/stream_uses.hpp"
#include "glsl/body.hpp"
#include "glsl/legalize.hpp"
#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/ir.hpp"
#include "ir/print.hpp"
#include "program/elements.hpp"
#include "sk/program.hpp"
#include "split/cost.hpp"

namespace skc::emit {

using namespace ir;

namespace {

// Translates the conditions found by guard-streams to the steps that the runtime evaluates.

using sk::program::ConditionOp;
using sk::program::ConditionStep;

ConditionOp opOf(BinaryOp op) {
  using enum ConditionOp;
  constexpr std::nullopt_t None = std::nullopt;
  constexpr std::optional<ConditionOp> ops[] = {
#define SKC_OPERATOR(Name, spelling, precedence, isAssociative, vectors, wide, condition) condition,
#include "ir/operators.def"
#undef SKC_OPERATOR
  };
  return ops[static_cast<std::size_t>(op)].value();   // guard-streams follows no other operator
}

/// The number of a Spec parameter among the kernel's Spec parameters.
std::uint32_t numberOf(const Kernel& kernel, VarId param) {
  return static_cast<std::uint32_t>(
      std::count_if(kernel.params.begin(), kernel.params.begin() + param,
                    [](const KernelParam& other) { return other.role == ParamRole::Spec; }));
}

void add(const Kernel& kernel, const Expr& expr, std::vector<ConditionStep>& steps) {
  const auto scalar = static_cast<sk::program::Scalar>(expr.type.scalar);
  if (const auto* n = std::get_if<Literal>(&expr.node)) {
    steps.push_back({ConditionOp::Literal, scalar, n->bits});
  } else if (const auto* ref = std::get_if<VarRef>(&expr.node)) {
    steps.push_back({ConditionOp::Spec, scalar, numberOf(kernel, ref->var)});
  } else if (const auto* conversion = std::get_if<Convert>(&expr.node)) {
    add(kernel, *conversion->operand, steps);   // bool, int or uint to int or uint keeps the bits
  } else if (const auto* negation = std::get_if<Unary>(&expr.node)) {
    add(kernel, *negation->operand, steps);
    steps.push_back({ConditionOp::Not, scalar});
  } else {
    const auto& binary = std::get<Binary>(expr.node);
    add(kernel, *binary.lhs, steps);
    add(kernel, *binary.rhs, steps);
    steps.push_back({opOf(binary.op), static_cast<sk::program::Scalar>(binary.lhs->type.scalar)});
  }
}

/// Whether one element may take so many iterations of loops that those of a packed texel, or of the 1024 elements of a row that one
/// invocation folds, could exceed the 65,535 of Mesa's llvmpipe (runtime/src/assemble/glsl/loop_check.glsl).
bool takesManyIterations(const Module& module, const Kernel& kernel) {
  const std::int64_t many = kernel.reduction ? 50 : 15000;
  return analysis::mostIterations(module, kernel).value_or(many + 1) > many;
}

std::vector<ConditionStep> conditionSteps(const Kernel& kernel, const Expr& condition) {
  std::vector<ConditionStep> steps;
  add(kernel, condition, steps);
  return steps;
}

}  // namespace

/// Owns what the descriptors' views refer to. Nothing in it moves after it is added.
struct Program::Storage {
  std::vector<std::shared_ptr<const void>> kept;
  std::map<std::tuple<Type::Kind, Scalar, std::uint8_t, std::uint32_t>, sk::program::Element> elements;
  std::map<const sk::program::Element*, Type> types;
  std::map<KernelId, sk::program::Kernel> kernels;
  std::map<const char*, KernelId> ids;  ///< by the body's address
  std::vector<const sk::program::Table*> tables;
  std::vector<Unit> units;

  template <class T>
  const T& keep(T value) {
    auto made = std::make_shared<const T>(std::move(value));
    const T& reference = *made;
    kept.push_back(std::move(made));
    return reference;
  }
  template <class T>
  std::span<const T> keep(std::vector<T> list) {
    return keep<std::vector<T>>(std::move(list));
  }
  std::string_view keep(std::string text) { return keep<std::string>(std::move(text)); }
};

namespace {

#define SKC_SCALAR(Name, spelling, cpp, arithmetic, bits, one) \
  static_assert(static_cast<int>(Scalar::Name) == static_cast<int>(sk::program::Scalar::Name));
#include "ir/scalars.def"
#undef SKC_SCALAR
static_assert(static_cast<int>(ParamRole::Spec) == static_cast<int>(sk::program::Role::Spec));
static_assert(static_cast<int>(ScatterOp::Max) == static_cast<int>(sk::program::ScatterOp::Max));
static_assert(static_cast<int>(sk::Precision::Double) == 4 && static_cast<int>(sk::Accumulate::Exact) == 4 &&
                  static_cast<int>(sk::Intrinsics::Accurate) == 2 && static_cast<int>(sk::Tables::On) == 2 &&
                  static_cast<int>(sk::Contraction::Fast) == 2 && static_cast<int>(sk::Order::Any) == 2,
              "frontend/choices.cpp has the same order");
static_assert(mostSpecs == sk::program::maxSpecs &&
              static_cast<int>(Reach::Kind::Whole) == static_cast<int>(sk::program::Reach::Kind::Whole));
static_assert(static_cast<int>(Boundary::Border) == static_cast<int>(sk::program::Boundary::Border));

/// A template only because Storage is private.
template <class Storage>
class Builder {
 public:
  /// `legal`: `module` after legalize, which has added the polyfills.
  Builder(const Module& legal, const Polyfills& polyfills, const Module& module, Targets targets,
          const CodeOf& codeOf, Storage& storage)
      : module_(legal),
        polyfills_(polyfills),
        given_(module),
        types_(legal),
        targets_(targets),
        codeOf_(codeOf),
        storage_(storage) {}

  void run() {
    std::vector<std::string_view> sources;
    for (const std::string& source : module_.sources) sources.push_back(storage_.keep(source));
    sources_ = storage_.keep(std::move(sources));
    for (const Table& table : module_.tables) storage_.tables.push_back(describe(table));
    for (KernelId id = 0; id < module_.kernels.size(); ++id) add(id);
  }

 private:
  void add(KernelId id) {
    const Kernel& declared = module_.kernels[id];
    if (!isUnit(declared)) return;
    Unit unit{.id = id, .kernel = kernel(id)};
    if (declared.reduction) {
      unit.reduction = &reduction(id, declared.reduction->commutative);
      unit.isScan = declared.isScan;
    }
    storage_.units.push_back(unit);
  }

  /// The descriptor of a whole kernel. All that refer to it have the same.
  const sk::program::Kernel& kernel(KernelId id) {
    if (const auto known = storage_.kernels.find(id); known != storage_.kernels.end()) return known->second;
    const Kernel& declared = module_.kernels[id];
    sk::program::Kernel made = describe(id);
    if (!declared.plans.empty()) {
      std::vector<sk::program::Plan> plans;
      for (const Plan& plan : declared.plans) plans.push_back(describe(plan));
      made.planCount = static_cast<std::uint8_t>(plans.size());
      made.plans = storage_.keep(std::move(plans)).data();
    }
    if (isUnit(declared)) {
      made.options = {.accumulate = static_cast<sk::Accumulate>(declared.choices.accumulate),
                      .precision = static_cast<sk::Precision>(declared.choices.precision),
                      .intrinsics = static_cast<sk::Intrinsics>(declared.choices.intrinsics),
                      .tables = static_cast<sk::Tables>(declared.choices.tables),
                      .contraction = static_cast<sk::Contraction>(declared.choices.contraction),
                      .order = static_cast<sk::Order>(declared.choices.order)};
    }
    if (isUnit(declared) || (declared.isPart && !declared.reduction)) {
      made.whyNotHalf = storage_.keep(declared.variants.whyNotHalf);
      made.whyNotWide = storage_.keep(declared.variants.whyNotWide);
    }
    if (!declared.reduction) addForms(declared, made);
    if (declared.assertions) made.assertions = &assertionCheck(*declared.assertions);
    return storage_.kernels.emplace(id, made).first->second;
  }

  const sk::program::AssertionCheck& assertionCheck(const AssertionCheck& declared) {
    if (assertions_.empty()) {
      std::vector<sk::program::Assertion> list;
      for (const Assertion& assertion : module_.assertions) {
        list.push_back(
            {storage_.keep(std::filesystem::path(module_.sources[assertion.loc.file]).filename().string()),
             assertion.loc.line, storage_.keep(assertion.text)});
      }
      assertions_ = storage_.keep(std::move(list));
    }
    return storage_.keep(sk::program::AssertionCheck{kernel(declared.check),
                                                     parameterNumbers(declared.operands), assertions_});
  }

  void addForms(const Kernel& declared, sk::program::Kernel& made) {
    if (declared.variants.half) made.half = &kernel(*declared.variants.half);
    if (declared.variants.wide) made.wide = &kernel(*declared.variants.wide);
    std::vector<sk::program::UnrolledKernel> unrolled;
    for (const UnrolledVariant& variant : declared.unrolled) {
      unrolled.push_back({static_cast<std::uint8_t>(numberOf(declared, variant.spec)), variant.value,
                          &kernel(variant.kernel)});
    }
    made.unrolled = storage_.keep(std::move(unrolled));
  }

  const sk::program::Table* describe(const Table& table) {
    if (!table.kernel) return nullptr;
    return &storage_.keep(sk::program::Table{
        .function = storage_.keep(qualifier(table.scope) + table.name),
        .range = {table.low, table.high, static_cast<std::int32_t>(table.intervals)},
        .interpolation = table.isCubic ? sk::Interpolation::Cubic : sk::Interpolation::Linear,
        .values = &kernel(*table.kernel)});
  }

  /// Describes a whole kernel without its forms and plans, or the kernel of a plan's pass.
  sk::program::Kernel describe(KernelId id, const Plan* plan = nullptr, const Pass* pass = nullptr) {
    const Kernel& kernel = module_.kernels[id];
    const KernelNames names(module_, kernel, types_);
    const GlslContext context{module_, types_, names, kernel, polyfills_, /*marks=*/true};
    const analysis::StreamUses uses = analysis::streamUses(module_, kernel);
    GlslBody text = kernel.isNativeOnly ? GlslBody() : glslBody(context);
    std::vector<sk::program::Parameter> parameters;
    for (std::uint32_t i = 0; i < kernel.params.size(); ++i) {
      parameters.push_back(parameter(context, i, uses.params[i]));
      if (plan != nullptr && !pass->operands[i].isTemporary) {
        parameters.back().layers = layersOf(*plan, pass->operands[i].index, parameters.back());
      }
    }
    std::vector<sk::program::TableUse> tables;
    for (const FunctionId function : tabulatedFunctionsOf(module_, kernel)) {
      tables.push_back(
          {storage_.tables[*module_.functions[function].table], storage_.keep(names.function(function))});
    }
    std::string name = qualifier(kernel.scope) + kernel.name;
    if (kernel.pass) name += fmt::format(" (pass {} of {})", kernel.pass->number, kernel.pass->count);
    const std::string_view body = storage_.keep(std::move(text.body));
    storage_.ids.emplace(body.data(), id);
    return {.name = storage_.keep(std::move(name)),
            .entry = storage_.keep(names.function(kernel.entry)),
            .declarations = storage_.keep(std::move(text.declarations)),
            .body = body,
            .weight = kernel.isNativeOnly ? 0 : split::weightOf(given_, given_.kernels[id]),
            .parameters = storage_.keep(std::move(parameters)),
            .sources = sources_,
            .usesIndex = uses.domainIndex,
            .usesExtent = uses.domainExtent,
            .usesLoops = uses.loops || takesManyIterations(given_, given_.kernels[id]),
            .usesDoubles = usesDoubles(module_, kernel),
            .usesLongs = usesLongs(module_, kernel),
            .usesExactSums = usesExactSums(module_, kernel),
            .intrinsics = storage_.keep(std::move(text.intrinsics)),
            .definitions = definitionsOf(text),
            .tables = storage_.keep(std::move(tables)),
            .drawn = targets_.fragment && !kernel.isNativeOnly,
            .dispatched = targets_.compute && !kernel.isNativeOnly,
            .code = codeOf_ ? codeOf_(id) : nullptr};
  }

  std::span<const sk::program::Definition> definitionsOf(GlslBody& text) {
    std::vector<sk::program::Definition> definitions;
    for (const std::size_t bytes : text.helpers)
      definitions.push_back({.bytes = static_cast<std::uint32_t>(bytes)});
    for (std::string& name : text.names) definitions.push_back({.name = storage_.keep(std::move(name))});
    return storage_.keep(std::move(definitions));
  }

  /// The GLSL for Reduction::addition.
  std::string_view addition(const Kernel& fold, const Kernel& combine) {
    const auto isFolded = [](const KernelParam& param) {
      return param.role == ParamRole::Input || param.role == ParamRole::Accumulator;
    };
    if (&combine == &fold || !std::ranges::all_of(combine.params, isFolded) ||
        !tabulatedFunctionsOf(module_, combine).empty() ||
        (usesDoubles(module_, combine) && !usesDoubles(module_, fold)) ||
        (usesLongs(module_, combine) && !usesLongs(module_, fold)) ||
        (usesExactSums(module_, combine) && !usesExactSums(module_, fold))) {
      return {};
    }
    const KernelNames names[] = {{module_, fold, types_}, {module_, combine, types_}};
    const GlslContext contexts[] = {{module_, types_, names[0], fold, polyfills_, /*marks=*/true},
                                    {module_, types_, names[1], combine, polyfills_, /*marks=*/true}};
    return storage_.keep(glslAddition(contexts[0], contexts[1]).value_or(""));
  }

  /// `commutative`: variants are where the reduction is that they stand for.
  const sk::program::Reduction& reduction(KernelId id, bool commutative) {
    const Kernel& declared = module_.kernels[id];
    const Reduction& plain = *declared.reduction;
    sk::program::Reduction made{.fold = kernel(id),
                                .combine = kernel(*plain.combine),
                                .combineOperands = combineOperands(plain),
                                .addition = addition(declared, module_.kernels[*plain.combine]),
                                .seeded = plain.seeded,
                                .compensated = compensated(plain),
                                .exact = exactSums(declared),
                                .commutative = commutative,
                                .term = sumInDoubles(plain),
                                .parts = parts(declared)};
    if (declared.variants.half) made.half = &reduction(*declared.variants.half, commutative);
    if (declared.variants.wide) made.wide = &wide(*declared.variants.wide, commutative);
    return storage_.keep(made);
  }

  const sk::program::WideReduction& wide(KernelId id, bool commutative) {
    return storage_.keep(sk::program::WideReduction{reduction(id, commutative),
                                                    kernel(*module_.kernels[id].reduction->finish)});
  }

  /// The value of Reduction::combineOperands; empty if the combining kernel has no operands but what is folded.
  std::span<const std::uint8_t> combineOperands(const Reduction& plain) {
    const bool hasOperands =
        std::ranges::any_of(module_.kernels[*plain.combine].params, [](const KernelParam& param) {
          return param.role != ParamRole::Input && param.role != ParamRole::Accumulator;
        });
    return hasOperands ? parameterNumbers(plain.operands) : std::span<const std::uint8_t>();
  }

  /// The value of Reduction::parts.
  const sk::program::FoldParts* parts(const Kernel& declared) {
    if (!declared.parts) return nullptr;
    const FoldParts& plain = *declared.parts;
    sk::program::FoldParts made{.map = kernel(plain.map), .mapOperands = parameterNumbers(plain.mapOperands)};
    if (plain.after) {
      made.after = &reduction(*plain.after, module_.kernels[*plain.after].reduction->commutative);
      made.afterOperands = parameterNumbers(plain.afterOperands);
    }
    if (plain.inDoubles && targets_.native)
      made.inDoubles = &wide(*plain.inDoubles, declared.reduction->commutative);
    return &storage_.keep(made);
  }

  /// The value of Reduction::term.
  sk::program::SumTerm sumInDoubles(const Reduction& plain) {
    if (!plain.compensated || plain.compensated->term.empty()) return {};
    return {.factors = parameterNumbers(plain.compensated->term)};
  }

  std::span<const sk::program::ExactSum> exactSums(const Kernel& reduce) {
    std::vector<sk::program::ExactSum> sums;
    for (const ExactSum& sum : reduce.reduction->exact) {
      sums.push_back({.reduction = reduction(sum.fold, true),
                      .finish = kernel(sum.finish),
                      .accumulator = static_cast<std::uint8_t>(sum.accumulator),
                      .offset = offsetOf(reduce, sum),
                      .ofProducts = sum.ofProducts,
                      .term = term(sum.term)});
    }
    return storage_.keep(std::move(sums));
  }

  std::uint32_t offsetOf(const Kernel& reduce, const ExactSum& sum) const {
    const Type accumulator = reduce.params[sum.accumulator].type;
    const std::uint32_t whole = emit::offsetOf(module_, types_, accumulator, sum.members);
    return whole + sum.component * static_cast<std::uint32_t>(sizeof(float));
  }

  /// Only native code computes terms with a kernel.
  sk::program::SumTerm term(const ExactTerm& made) {
    if (!made.kernel) return {.factors = parameterNumbers(made.factors)};
    if (!targets_.native) return {};
    return {.factors = {}, .kernel = &kernel(*made.kernel)};
  }

  std::span<const std::uint8_t> parameterNumbers(const std::vector<VarId>& parameters) {
    return storage_.keep(std::vector<std::uint8_t>(parameters.begin(), parameters.end()));
  }

  /// Returns null if the reduction has no compensated variant.
  const sk::program::CompensatedReduction* compensated(const Reduction& plain) {
    if (!plain.compensated) return nullptr;
    const Kernel& fold = module_.kernels[plain.compensated->fold];
    std::vector<sk::program::CompensatedSum> sums;
    for (const AccumulatorPart& sum : plain.compensated->sums) {
      sums.push_back({static_cast<std::uint8_t>(sum.accumulator),
                      emit::offsetOf(module_, types_, fold.params[sum.accumulator].type, sum.members)});
    }
    return &storage_.keep(sk::program::CompensatedReduction{
        reduction(plain.compensated->fold, plain.commutative), kernel(plain.compensated->finish),
        storage_.keep(std::move(sums)), plain.compensated->addsDoubles});
  }

  // ---- plans ------------------------------------------------------------------------------------

  sk::program::Plan describe(const Plan& plan) {
    std::vector<const sk::program::Element*> temporaries;
    for (const Temporary& temporary : plan.temporaries) temporaries.push_back(&element(temporary.type));
    std::vector<sk::program::Stack> stacks;
    for (const Stack& stack : plan.stacks) {
      std::vector<sk::program::ArgumentPlane> layers;
      for (const ArgumentPlane& plane : stack.layers) {
        layers.push_back({static_cast<std::uint8_t>(plane.argument), static_cast<std::uint8_t>(plane.plane)});
      }
      stacks.push_back({static_cast<sk::program::Scalar>(stack.type.scalar), stack.type.width,
                        storage_.keep(std::move(layers))});
    }
    std::vector<sk::program::Pass> passes;
    for (const Pass& pass : plan.passes) {
      std::vector<sk::program::PassOperand> operands;
      for (const PassOperand& operand : pass.operands) {
        operands.push_back({operand.isTemporary, static_cast<std::uint8_t>(operand.index)});
      }
      passes.push_back({describe(pass.kernel, &plan, &pass), storage_.keep(std::move(operands))});
    }
    return {.drawBuffers = static_cast<std::uint8_t>(plan.limits.drawBuffers),
            .textureUnits = static_cast<std::uint8_t>(plan.limits.textureUnits),
            .temporaries = storage_.keep(std::move(temporaries)),
            .stacks = storage_.keep(std::move(stacks)),
            .passes = storage_.keep(std::move(passes))};
  }

  /// The layers that hold the stacked planes of an argument; empty if none is stacked. Outputs never are.
  std::span<const sk::program::Layer> layersOf(const Plan& plan, std::uint32_t argument,
                                               const sk::program::Parameter& parameter) {
    if (parameter.role == sk::program::Role::Output) return {};
    std::vector<sk::program::Layer> layers(heldBy(parameter).fields.size());
    bool isStacked = false;
    for (std::size_t b = 0; b < plan.stacks.size(); ++b) {
      const std::vector<ArgumentPlane>& places = plan.stacks[b].layers;
      for (std::size_t layer = 0; layer < places.size(); ++layer) {
        if (places[layer].argument != argument) continue;
        layers[places[layer].plane] = {static_cast<std::int8_t>(b), static_cast<std::uint8_t>(layer),
                                       static_cast<std::uint8_t>(places.size())};
        isStacked = true;
      }
    }
    if (!isStacked) return {};
    return storage_.keep(std::move(layers));
  }

  sk::program::Parameter parameter(const GlslContext& context, std::uint32_t index,
                                   const analysis::StreamUse& use) {
    const KernelParam& param = context.kernel.params[index];
    const auto constant = [&](const ExprPtr& expr) {
      return expr ? storage_.keep(glslExpr(context, std::nullopt, *expr)) : std::string_view();
    };
    return {.name = storage_.keep(param.name),
            .symbol = storage_.keep(context.names.symbol(index)),
            .role = static_cast<sk::program::Role>(param.role),
            .element = &element(param.type),
            .held = param.held ? &element(*param.held) : nullptr,
            .rank = param.rank,
            .boundary = static_cast<sk::program::Boundary>(param.boundary),
            .border = constant(param.border),
            .identity = constant(param.identity),
            .scatter = static_cast<sk::program::ScatterOp>(param.scatter),
            .pushes = param.pushes,
            .usesIndex = use.index,
            .usesExtent = use.extent,
            .usesAt = use.at,
            .usesNear = use.near,
            .usesSample = use.sample,
            .filter = param.filter,
            .reach = use.reach,
            .neededIf = condition(context, param),
            .firstPlane = static_cast<std::uint8_t>(param.firstPlane),
            .planeCount = static_cast<std::uint8_t>(param.planeCount),
            .halo = reachOf(param),
            .haloShapes = param.reachShapes,
            .range = rangeOf(context.kernel, param)};
  }

  /// Only declared kernels have ranges: the values between the passes of a kernel need not be in any.
  static std::optional<sk::program::ValueRange> rangeOf(const Kernel& kernel, const KernelParam& param) {
    if (!param.range || !isUnit(kernel)) return std::nullopt;
    return sk::program::ValueRange{param.range->low, param.range->high};
  }

  std::span<const sk::program::Reach> reachOf(const KernelParam& param) {
    const auto distance = [](const Distance& from) {
      return sk::program::Distance{from.constant, from.perSpec};
    };
    std::vector<sk::program::Reach> made;
    for (const Reach& reach : param.reach) {
      made.push_back({reach.dimension, static_cast<sk::program::Reach::Kind>(reach.kind),
                      distance(reach.below), distance(reach.above), reach.isPromised});
    }
    return storage_.keep(std::move(made));
  }

  sk::program::Condition condition(const GlslContext& context, const KernelParam& param) {
    if (!param.neededIf) return {};
    Function entry;
    entry.variables = module_.functions[context.kernel.entry].variables;
    // the program knows members of bundles by their paths
    for (std::size_t i = 0; i < context.kernel.params.size(); ++i)
      entry.variables[i].name = context.kernel.params[i].name;
    return {.steps = storage_.keep(conditionSteps(context.kernel, *param.neededIf)),
            .text = storage_.keep(print(module_, entry, *param.neededIf))};
  }

  const sk::program::Element& element(Type type) {
    const auto key = std::tuple(type.kind, type.scalar, type.width, type.index);
    if (const auto known = storage_.elements.find(key); known != storage_.elements.end())
      return known->second;
    const ElementLayout layout = elementLayout(module_, types_, type);
    std::vector<sk::program::Field> fields;
    for (const Plane& plane : layout.planes) {
      fields.push_back({.path = storage_.keep(plane.path),
                        .scalar = static_cast<sk::program::Scalar>(plane.type.scalar),
                        .width = plane.type.width,
                        .offset = plane.offset,
                        .part = static_cast<std::int8_t>(plane.part)});
    }
    sk::program::Element made{.name = storage_.keep(print(module_, type)),
                              .glsl = storage_.keep(types_.glsl(type)),
                              .size = layout.size,
                              .fields = storage_.keep(std::move(fields))};
    const sk::program::Element& kept = storage_.elements.emplace(key, made).first->second;
    storage_.types.emplace(&kept, type);
    return kept;
  }

  const Module& module_;
  const Polyfills& polyfills_;
  const Module& given_;
  TypeNames types_;
  const Targets targets_;
  const CodeOf& codeOf_;
  Storage& storage_;
  std::span<const std::string_view> sources_;
  std::span<const sk::program::Assertion> assertions_;
};

}  // namespace

Program::Program(const Module& module, Targets targets, const CodeOf& codeOf)
    : storage_(std::make_unique<Storage>()) {
  Module legal = ir::clone(module);
  const Polyfills polyfills = legalize(legal, glslCapabilities);
  Builder<Storage>(legal, polyfills, module, targets, codeOf, *storage_).run();
}
Program::Program(Program&&) noexcept = default;
Program& Program::operator=(Program&&) noexcept = default;
Program::~Program() = default;

std::span<const Unit> Program::units() const { return storage_->units; }
std::span<const sk::program::Table* const> Program::tables() const { return storage_->tables; }
Type Program::typeOf(const sk::program::Element& element) const { return storage_->types.at(&element); }
KernelId Program::idOf(const sk::program::Kernel& kernel) const {
  return storage_->ids.at(kernel.body.data());
}

}  // namespace skc::emit
