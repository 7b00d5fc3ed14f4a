// SPDX-License-Identifier: MIT
#include "program/descriptors.hpp"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/stream_uses.hpp"
#include "assemble/glsl/own_arithmetic.hpp"
#include "glsl/body.hpp"
#include "ir/call_graph.hpp"
#include "ir/ir.hpp"
#include "ir/print.hpp"
#include "program/elements.hpp"
#include "sk/program.hpp"

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
#define SKC_OPERATOR(Name, spelling, precedence, isAssociative, vectors, doubles, condition) condition,
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

std::vector<ConditionStep> conditionSteps(const Kernel& kernel, const Expr& condition) {
  std::vector<ConditionStep> steps;
  add(kernel, condition, steps);
  return steps;
}

}  // namespace

/// Owns what the descriptors' views refer to. Nothing in it moves after it is added.
struct Program::Storage {
  std::deque<std::string> strings;
  std::deque<std::vector<sk::program::Field>> fields;
  std::map<std::tuple<Type::Kind, Scalar, std::uint8_t, std::uint32_t>, sk::program::Element> elements;
  std::deque<std::vector<sk::program::ConditionStep>> conditions;
  std::deque<std::vector<sk::program::Reach>> reaches;
  std::deque<std::vector<sk::program::Parameter>> parameters;
  std::vector<std::string_view> sources;
  std::deque<sk::program::Reduction> reductions;
  std::deque<sk::program::FoldParts> parts;
  std::deque<sk::program::CompensatedReduction> compensated;
  std::deque<std::vector<sk::program::CompensatedSum>> compensatedSums;
  std::deque<sk::program::WideReduction> wide;
  std::deque<sk::program::Kernel> forms;
  std::deque<std::vector<sk::program::UnrolledKernel>> unrolled;
  std::deque<std::vector<sk::program::ExactSum>> exact;
  std::deque<std::vector<std::uint8_t>> combineOperands;
  std::deque<std::vector<std::uint8_t>> factors;
  std::deque<std::vector<sk::program::Layer>> layers;
  std::deque<std::vector<sk::program::IntrinsicUse>> intrinsics;
  std::deque<sk::program::Table> tables;
  std::vector<const sk::program::Table*> tableList;
  std::deque<std::vector<sk::program::TableUse>> tableUses;
  std::deque<std::vector<const sk::program::Element*>> temporaries;
  std::deque<std::vector<sk::program::ArgumentPlane>> bundleLayers;
  std::deque<std::vector<sk::program::Bundle>> bundles;
  std::deque<std::vector<sk::program::PassOperand>> operands;
  std::deque<std::vector<sk::program::Pass>> passes;
  std::deque<std::vector<sk::program::Plan>> plans;
  std::vector<Unit> units;

  std::string_view keep(std::string text) { return strings.emplace_back(std::move(text)); }
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
  Builder(const Module& module, GlslTargets targets, const CodeOf& codeOf, Storage& storage)
      : module_(module), types_(module), targets_(targets), codeOf_(codeOf), storage_(storage) {}

  void run() {
    for (const std::string& source : module_.sources) storage_.sources.push_back(storage_.keep(source));
    for (const Table& table : module_.tables) storage_.tableList.push_back(describe(table));
    for (KernelId id = 0; id < module_.kernels.size(); ++id) add(id);
  }

 private:
  void add(KernelId id) {
    const Kernel& kernel = module_.kernels[id];
    if (!isUnit(kernel)) return;
    Unit unit{.id = id, .kernel = whole(kernel)};
    unit.kernel.options = {.accumulate = static_cast<sk::Accumulate>(kernel.choices.accumulate),
                           .precision = static_cast<sk::Precision>(kernel.choices.precision),
                           .intrinsics = static_cast<sk::Intrinsics>(kernel.choices.intrinsics),
                           .tables = static_cast<sk::Tables>(kernel.choices.tables),
                           .contraction = static_cast<sk::Contraction>(kernel.choices.contraction),
                           .order = static_cast<sk::Order>(kernel.choices.order)};
    unit.kernel.whyNotHalf = storage_.keep(kernel.variants.whyNotHalf);
    unit.kernel.whyNotWide = storage_.keep(kernel.variants.whyNotWide);
    if (kernel.reduction) {
      unit.reduction = &storage_.reductions.emplace_back(reduction(kernel, unit.kernel));
      unit.isScan = kernel.isScan;
      addForms(kernel, storage_.reductions.back());
    } else {
      addForms(kernel, unit.kernel);
      addUnrolled(kernel, unit.kernel);
    }
    storage_.units.push_back(unit);
  }

  void addUnrolled(const Kernel& kernel, sk::program::Kernel& made) {
    std::vector<sk::program::UnrolledKernel>& all = storage_.unrolled.emplace_back();
    for (const UnrolledVariant& variant : kernel.unrolled) {
      const auto before =
          std::count_if(kernel.params.begin(), kernel.params.begin() + variant.spec,
                        [](const KernelParam& param) { return param.role == ParamRole::Spec; });
      all.push_back({static_cast<std::uint8_t>(before), variant.value, &form(variant.kernel)});
    }
    made.unrolled = all;
  }

  void addForms(const Kernel& kernel, sk::program::Kernel& made) {
    if (kernel.variants.half) made.half = &form(*kernel.variants.half);
    if (kernel.variants.wide) made.wide = &form(*kernel.variants.wide);
  }

  const sk::program::Table* describe(const Table& table) {
    if (!table.kernel) return nullptr;
    return &storage_.tables.emplace_back(sk::program::Table{
        .function = storage_.keep(qualifier(table.scope) + table.name),
        .range = {table.low, table.high, static_cast<std::int32_t>(table.intervals)},
        .interpolation = table.isCubic ? sk::Interpolation::Cubic : sk::Interpolation::Linear,
        .values = &form(*table.kernel)});
  }

  sk::program::Kernel whole(const Kernel& kernel) {
    sk::program::Kernel made = describe(kernel);
    addPlans(kernel, made);
    return made;
  }

  const sk::program::Kernel& form(KernelId id) {
    return storage_.forms.emplace_back(whole(module_.kernels[id]));
  }

  void addForms(const Kernel& kernel, sk::program::Reduction& made) {
    if (kernel.variants.half) {
      const Kernel& half = module_.kernels[*kernel.variants.half];
      sk::program::Reduction& form = storage_.reductions.emplace_back(reduction(half, describe(half)));
      form.commutative = made.commutative;
      made.half = &form;
    }
    if (kernel.variants.wide) {
      const Kernel& wide = module_.kernels[*kernel.variants.wide];
      sk::program::WideReduction& form = storage_.wide.emplace_back(sk::program::WideReduction{
          reduction(wide, describe(wide)), whole(module_.kernels[*wide.reduction->finish])});
      form.reduction.commutative = made.commutative;
      made.wide = &form;
    }
  }

  /// Describes a whole kernel, or the kernel of a plan's pass.
  sk::program::Kernel describe(const Kernel& kernel, const Plan* plan = nullptr, const Pass* pass = nullptr) {
    const KernelNames names(module_, kernel, types_);
    Polyfills polyfills;
    const GlslContext context{module_, types_, names, kernel, polyfills, /*marks=*/true};
    const analysis::StreamUses uses = analysis::streamUses(module_, kernel);
    GlslBody text = kernel.isNativeOnly ? GlslBody() : glslBody(context);
    std::vector<sk::program::Parameter>& parameters = storage_.parameters.emplace_back();
    for (std::uint32_t i = 0; i < kernel.params.size(); ++i) {
      parameters.push_back(parameter(context, i, uses.params[i]));
      if (plan != nullptr && !pass->operands[i].isTemporary) {
        parameters.back().layers = layersOf(*plan, pass->operands[i].index, parameters.back());
      }
    }
    std::vector<sk::program::TableUse>& tables = storage_.tableUses.emplace_back();
    for (const FunctionId id : tabulatedFunctionsOf(module_, kernel)) {
      tables.push_back({storage_.tableList[*module_.functions[id].table], storage_.keep(names.function(id))});
    }
    const std::size_t length = sk::assemble::unmarked(text.body).size();
    std::string name = qualifier(kernel.scope) + kernel.name;
    if (kernel.pass) name += fmt::format(" (pass {} of {})", kernel.pass->number, kernel.pass->count);
    return {.name = storage_.keep(std::move(name)),
            .entry = storage_.keep(names.function(kernel.entry)),
            .declarations = storage_.keep(std::move(text.declarations)),
            .body = storage_.keep(std::move(text.body)),
            .bodyLength = length,
            .parameters = parameters,
            .sources = storage_.sources,
            .usesIndex = uses.domainIndex,
            .usesExtent = uses.domainExtent,
            .usesLoops = uses.loops,
            .usesDoubles = usesDoubles(module_, kernel),
            .usesExactSums = usesExactSums(module_, kernel),
            .intrinsics = storage_.intrinsics.emplace_back(polyfills.intrinsics()),
            .tables = tables,
            .drawn = targets_.fragment && !kernel.isNativeOnly,
            .dispatched = targets_.compute && !kernel.isNativeOnly,
            .code = codeOf_ ? codeOf_(static_cast<KernelId>(&kernel - module_.kernels.data())) : nullptr};
  }

  /// The GLSL for Reduction::addition.
  std::string_view addition(const Kernel& fold, const Kernel& combine) {
    const auto isFolded = [](const KernelParam& param) {
      return param.role == ParamRole::Input || param.role == ParamRole::Accumulator;
    };
    if (&combine == &fold || !std::ranges::all_of(combine.params, isFolded) ||
        !tabulatedFunctionsOf(module_, combine).empty() ||
        (usesDoubles(module_, combine) && !usesDoubles(module_, fold)) ||
        (usesExactSums(module_, combine) && !usesExactSums(module_, fold))) {
      return {};
    }
    const KernelNames names[] = {{module_, fold, types_}, {module_, combine, types_}};
    Polyfills polyfills[2];
    const GlslContext contexts[] = {{module_, types_, names[0], fold, polyfills[0], /*marks=*/true},
                                    {module_, types_, names[1], combine, polyfills[1], /*marks=*/true}};
    for (const GlslContext& context : contexts) glslBody(context);
    return storage_.keep(glslAddition(contexts[0], contexts[1]).value_or(""));
  }

  sk::program::Reduction reduction(const Kernel& kernel, const sk::program::Kernel& fold) {
    const Kernel& combine = module_.kernels[*kernel.reduction->combine];
    std::vector<std::uint8_t>& operands = storage_.combineOperands.emplace_back();
    for (std::uint32_t operand : kernel.reduction->operands) {
      operands.push_back(static_cast<std::uint8_t>(operand));
    }
    return {.fold = fold,
            .combine = &combine == &kernel ? fold : describe(combine),
            .combineOperands = operands,
            .addition = addition(kernel, combine),
            .seeded = kernel.reduction->seeded,
            .compensated = compensated(*kernel.reduction),
            .exact = exactSums(kernel),
            .commutative = kernel.reduction->commutative,
            .term = sumInDoubles(*kernel.reduction),
            .parts = parts(kernel)};
  }

  /// The value of Reduction::parts.
  const sk::program::FoldParts* parts(const Kernel& kernel) {
    if (!kernel.parts) return nullptr;
    const Kernel& map = module_.kernels[kernel.parts->map];
    sk::program::FoldParts made{.map = whole(map),
                                .mapOperands = parameterNumbers(kernel.parts->mapOperands)};
    addForms(map, made.map);
    made.map.whyNotHalf = storage_.keep(map.variants.whyNotHalf);
    made.map.whyNotWide = storage_.keep(map.variants.whyNotWide);
    if (kernel.parts->after) {
      const Kernel& after = module_.kernels[*kernel.parts->after];
      made.after = &storage_.reductions.emplace_back(reduction(after, describe(after)));
      made.afterOperands = parameterNumbers(kernel.parts->afterOperands);
    }
    if (kernel.parts->inDoubles) {
      const Kernel& fold = module_.kernels[*kernel.parts->inDoubles];
      made.inDoubles = &storage_.wide.emplace_back(sk::program::WideReduction{
          reduction(fold, describe(fold)), whole(module_.kernels[*fold.reduction->finish])});
      storage_.wide.back().reduction.commutative = kernel.reduction->commutative;
    }
    return &storage_.parts.emplace_back(std::move(made));
  }

  /// The value of Reduction::term.
  sk::program::SumTerm sumInDoubles(const Reduction& plain) {
    if (!plain.compensated || plain.compensated->term.empty()) return {};
    return {.factors = parameterNumbers(plain.compensated->term)};
  }

  std::span<const sk::program::ExactSum> exactSums(const Kernel& reduce) {
    if (reduce.reduction->exact.empty()) return {};
    std::vector<sk::program::ExactSum> sums;
    for (const ExactSum& sum : reduce.reduction->exact) {
      const Kernel& fold = module_.kernels[sum.fold];
      sums.push_back({.reduction = reduction(fold, describe(fold)),
                      .finish = whole(module_.kernels[sum.finish]),
                      .accumulator = static_cast<std::uint8_t>(sum.accumulator),
                      .offset = offsetOf(reduce, sum),
                      .ofProducts = sum.ofProducts,
                      .term = term(sum.term)});
      sums.back().reduction.commutative = true;
    }
    return storage_.exact.emplace_back(std::move(sums));
  }

  std::uint32_t offsetOf(const Kernel& reduce, const ExactSum& sum) const {
    const Type accumulator = reduce.params[sum.accumulator].type;
    const std::uint32_t whole = emit::offsetOf(module_, types_, accumulator, sum.members);
    return whole + sum.component * static_cast<std::uint32_t>(sizeof(float));
  }

  sk::program::SumTerm term(const ExactTerm& made) {
    if (made.kernel) return {.factors = {}, .kernel = &form(*made.kernel)};
    return {.factors = parameterNumbers(made.factors)};
  }

  std::span<const std::uint8_t> parameterNumbers(const std::vector<VarId>& parameters) {
    return storage_.factors.emplace_back(parameters.begin(), parameters.end());
  }

  /// Returns null if the reduction has no compensated variant.
  const sk::program::CompensatedReduction* compensated(const Reduction& plain) {
    if (!plain.compensated) return nullptr;
    const Kernel& fold = module_.kernels[plain.compensated->fold];
    std::vector<sk::program::CompensatedSum>& sums = storage_.compensatedSums.emplace_back();
    for (const auto& [accumulator, members] : plain.compensated->sums) {
      sums.push_back({static_cast<std::uint8_t>(accumulator),
                      emit::offsetOf(module_, types_, fold.params[accumulator].type, members)});
    }
    sk::program::CompensatedReduction& made =
        storage_.compensated.emplace_back(sk::program::CompensatedReduction{
            reduction(fold, describe(fold)), whole(module_.kernels[plain.compensated->finish]), sums,
            plain.compensated->addsDoubles});
    made.reduction.commutative = plain.commutative;
    return &made;
  }

  // ---- plans ------------------------------------------------------------------------------------

  void addPlans(const Kernel& kernel, sk::program::Kernel& made) {
    if (kernel.plans.empty()) return;
    std::vector<sk::program::Plan>& plans = storage_.plans.emplace_back();
    for (const Plan& plan : kernel.plans) plans.push_back(describe(plan));
    made.plans = plans.data();
    made.planCount = static_cast<std::uint8_t>(plans.size());
  }

  sk::program::Plan describe(const Plan& plan) {
    std::vector<const sk::program::Element*>& temporaries = storage_.temporaries.emplace_back();
    for (const Temporary& temporary : plan.temporaries) temporaries.push_back(&element(temporary.type));
    std::vector<sk::program::Bundle>& bundles = storage_.bundles.emplace_back();
    for (const Bundle& bundle : plan.bundles) {
      std::vector<sk::program::ArgumentPlane>& layers = storage_.bundleLayers.emplace_back();
      for (const ArgumentPlane& plane : bundle.layers) {
        layers.push_back({static_cast<std::uint8_t>(plane.argument), static_cast<std::uint8_t>(plane.plane)});
      }
      bundles.push_back({static_cast<sk::program::Scalar>(bundle.type.scalar), bundle.type.width, layers});
    }
    std::vector<sk::program::Pass>& passes = storage_.passes.emplace_back();
    for (const Pass& pass : plan.passes) {
      std::vector<sk::program::PassOperand>& operands = storage_.operands.emplace_back();
      for (const PassOperand& operand : pass.operands) {
        operands.push_back({operand.isTemporary, static_cast<std::uint8_t>(operand.index)});
      }
      passes.push_back({describe(module_.kernels[pass.kernel], &plan, &pass), operands});
    }
    return {.drawBuffers = static_cast<std::uint8_t>(plan.limits.drawBuffers),
            .textureUnits = static_cast<std::uint8_t>(plan.limits.textureUnits),
            .temporaries = temporaries,
            .bundles = bundles,
            .passes = passes};
  }

  /// The layers that hold the bundled planes of an argument; empty if none is bundled. Outputs never are.
  std::span<const sk::program::Layer> layersOf(const Plan& plan, std::uint32_t argument,
                                               const sk::program::Parameter& parameter) {
    if (parameter.role == sk::program::Role::Output) return {};
    std::vector<sk::program::Layer> layers(heldBy(parameter).fields.size());
    bool isBundled = false;
    for (std::size_t b = 0; b < plan.bundles.size(); ++b) {
      const std::vector<ArgumentPlane>& places = plan.bundles[b].layers;
      for (std::size_t layer = 0; layer < places.size(); ++layer) {
        if (places[layer].argument != argument) continue;
        layers[places[layer].plane] = {static_cast<std::int8_t>(b), static_cast<std::uint8_t>(layer),
                                       static_cast<std::uint8_t>(places.size())};
        isBundled = true;
      }
    }
    if (!isBundled) return {};
    return storage_.layers.emplace_back(std::move(layers));
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
            .haloShapes = param.reachShapes};
  }

  std::span<const sk::program::Reach> reachOf(const KernelParam& param) {
    if (param.reach.empty()) return {};
    const auto distance = [](const Distance& from) {
      return sk::program::Distance{from.constant, from.perSpec};
    };
    std::vector<sk::program::Reach>& made = storage_.reaches.emplace_back();
    for (const Reach& reach : param.reach) {
      made.push_back({reach.dimension, static_cast<sk::program::Reach::Kind>(reach.kind),
                      distance(reach.below), distance(reach.above), reach.isPromised});
    }
    return made;
  }

  sk::program::Condition condition(const GlslContext& context, const KernelParam& param) {
    if (!param.neededIf) return {};
    const Function& entry = module_.functions[context.kernel.entry];
    return {.steps = storage_.conditions.emplace_back(conditionSteps(context.kernel, *param.neededIf)),
            .text = storage_.keep(print(module_, entry, *param.neededIf))};
  }

  const sk::program::Element& element(Type type) {
    const auto key = std::tuple(type.kind, type.scalar, type.width, type.index);
    if (const auto known = storage_.elements.find(key); known != storage_.elements.end())
      return known->second;
    const ElementLayout layout = elementLayout(module_, types_, type);
    std::vector<sk::program::Field>& fields = storage_.fields.emplace_back();
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
                              .fields = fields};
    return storage_.elements.emplace(key, made).first->second;
  }

  const Module& module_;
  TypeNames types_;
  const GlslTargets targets_;
  const CodeOf& codeOf_;
  Storage& storage_;
};

}  // namespace

Program::Program(const Module& module, GlslTargets targets, const CodeOf& codeOf)
    : storage_(std::make_unique<Storage>()) {
  Builder<Storage>(module, targets, codeOf, *storage_).run();
}
Program::Program(Program&&) noexcept = default;
Program& Program::operator=(Program&&) noexcept = default;
Program::~Program() = default;

std::span<const Unit> Program::units() const { return storage_->units; }
std::span<const sk::program::Table* const> Program::tables() const { return storage_->tableList; }

}  // namespace skc::emit
