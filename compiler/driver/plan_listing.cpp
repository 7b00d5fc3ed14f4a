// SPDX-License-Identifier: MIT
#include "driver/listings.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "assemble/assemble.hpp"
#include "assemble/reduce/reduce_plan.hpp"
#include "assemble/reduce/scan_plan.hpp"
#include "ir/print.hpp"
#include "split/cost.hpp"
#include "split/slice.hpp"
#include "support/text.hpp"

namespace skc::driver {
namespace {

using namespace ir;

std::string counted(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : what == "pass" ? "es" : "s");
}

class PlanPrinter {
 public:
  PlanPrinter(const Module& module, std::string_view name, const Limits& limits)
      : module_(module), name_(name), limits_(limits) {}

  std::string print() {
    text_ = fmt::format("{}: {} draw buffers, {} texture units\n", name_, limits_.drawBuffers,
                        limits_.textureUnits);
    for (const Kernel& kernel : module_.kernels) {
      if (kernel.pass || kernel.isSynthesized) continue;
      text_ += fmt::format("\n{} {}{}: ", ir::wordOf(kernel), qualifier(kernel.scope), kernel.name);
      if (kernel.isPart) text_ += isCheck(kernel) ? "its assertions: " : "a part: ";
      if (kernel.parts) {
        text_ += fmt::format("natively 1 pass; on other targets its outputs, then {}\n",
                             kernel.parts->after ? "the reduce of these" : "the reduce without them");
      } else {
        kernel.isScan ? printScan() : kernel.reduction ? printReduce() : printKernel(kernel);
      }
      printScatters(kernel);
      printReaches(kernel);
      for (const LoopNote& loop : kernel.loops) printLoop(loop);
    }
    for (const Pipeline& pipeline : module_.pipelines) printPipeline(pipeline);
    return std::move(text_);
  }

 private:
  void printPipeline(const Pipeline& pipeline) {
    text_ += fmt::format("\npipeline {}{}: {}", qualifier(pipeline.face.scope), pipeline.face.name,
                         counted(pipeline.passes.size(), "kernel"));
    if (pipeline.bytesOfPasses < pipeline.bytesOfCalls) {
      text_ += fmt::format(", {} bytes of memory an element instead of {} call by call",
                           pipeline.bytesOfPasses, pipeline.bytesOfCalls);
    }
    text_ += "\n";
    for (const PipelinePass& pass : pipeline.passes) {
      std::vector<std::string> written;
      for (std::size_t i = 0; i < pass.operands.size(); ++i) {
        if (pass.operands[i].isTemporary && module_.kernels[pass.kernel].params[i].role == ParamRole::Output)
          written.push_back(pipeline.locals[pass.operands[i].index].name);
      }
      text_ +=
          wrapLine(fmt::format("  {}: {}{}", module_.kernels[pass.kernel].name, join(pass.calls, ", then "),
                               written.empty() ? "" : fmt::format("; stores {}", join(written, ", "))),
                   100, 4) +
          "\n";
    }
  }

  bool isCheck(const Kernel& part) const {
    return std::ranges::any_of(module_.kernels, [&](const Kernel& kernel) {
      return kernel.assertions && &module_.kernels[kernel.assertions->check] == &part;
    });
  }

  // ---- kernels ----------------------------------------------------------------------------------

  void printKernel(const Kernel& kernel) {
    const Limits demand = split::demandOf(module_, kernel);
    text_ += fmt::format("{} written, {} read", counted(demand.drawBuffers, "plane"), demand.textureUnits);
    const bool fits =
        demand.drawBuffers <= limits_.drawBuffers && demand.textureUnits <= limits_.textureUnits;
    const auto plan = std::ranges::find_if(kernel.plans, [&](const Plan& one) {
      return one.limits.drawBuffers <= limits_.drawBuffers && one.limits.textureUnits <= limits_.textureUnits;
    });
    if (fits || plan == kernel.plans.end()) {
      text_ += ": 1 pass\n";
      return;
    }
    text_ += fmt::format(": {}, cost {:.0f} an element\n", counted(plan->passes.size(), "pass"), plan->cost);
    for (std::size_t i = 0; i < plan->passes.size(); ++i) printPass(kernel, *plan, i);
    for (const Temporary& temporary : plan->temporaries) printTemporary(temporary);
    if (!plan->temporaries.empty()) {
      text_ += fmt::format("  with nothing saved the cost were {:.0f}\n", plan->costWithoutTemporaries);
    }
    for (const Stack& stack : plan->stacks) printStack(kernel, stack);
  }

  /// Prints which scatter outputs combine values by sorted records in compute programs (assemble::isListed).
  void printScatters(const Kernel& kernel) {
    const bool isKept = kernel.choices.order != static_cast<std::uint8_t>(sk::Order::Any);
    for (const KernelParam& param : kernel.params) {
      if (param.role != ParamRole::Scatter || param.scatter == ScatterOp::Store) continue;
      const bool isOrdered = param.type.isFloat() && param.scatter == ScatterOp::Add && isKept;
      if (param.type.isVector() || isOrdered) {
        text_ += fmt::format(
            "  {} combines values in order: drawn, as points; dispatched, as sorted records\n", param.name);
      }
    }
  }

  /// Prints how far from its element a kernel reads each gather.
  void printReaches(const Kernel& kernel) {
    for (const KernelParam& param : kernel.params) {
      if (param.reach.empty()) continue;
      text_ += wrapLine(fmt::format("  reach of {}: {}{}", param.name, ir::printReach(kernel, param),
                                    shapes(kernel, param)),
                        100, 4) +
               "\n";
    }
  }

  /// The condition under which a reach holds.
  static std::string shapes(const Kernel& kernel, const KernelParam& reached) {
    std::vector<std::string> names;
    for (std::size_t p = 0; p < kernel.params.size(); ++p) {
      if ((reached.reachShapes >> p & 1) != 0) names.push_back(kernel.params[p].name);
    }
    if (names.empty()) return "";
    return fmt::format(", if {} {} the domain's shape", join(names, " and "),
                       names.size() == 1 ? "has" : "have");
  }

  void printPass(const Kernel& kernel, const Plan& plan, std::size_t number) {
    const Pass& pass = plan.passes[number];
    std::vector<std::string> reads, writes;
    for (std::size_t i = 0; i < pass.operands.size(); ++i) {
      const KernelParam& param = module_.kernels[pass.kernel].params[i];
      (param.role == ParamRole::Output ? writes : reads)
          .push_back(name(kernel, plan, pass.operands[i], param));
    }
    text_ += fmt::format("  pass {}, cost {:.0f}\n", number + 1, pass.cost);
    text_ += wrapLine("    reads " + (reads.empty() ? "nothing" : join(reads, ", ")), 100, 10) + "\n";
    text_ += wrapLine("    writes " + join(writes, ", "), 100, 11) + "\n";
  }

  static std::string name(const Kernel& kernel, const Plan& plan, const PassOperand& operand,
                          const KernelParam& param) {
    if (operand.isTemporary) return plan.temporaries[operand.index].name + " (saved)";
    std::string text = kernel.params[operand.index].name;
    if (param.planeCount != 0) {
      text += fmt::format(" (planes {} to {})", param.firstPlane, param.firstPlane + param.planeCount - 1);
    }
    return text;
  }

  void printTemporary(const Temporary& temporary) {
    const double element = split::elementCost(module_, temporary.type);
    text_ += fmt::format(
        "  {} {} is saved: computing it costs {:.0f}, writing it {:.0f}, reading it in {} {:.0f}\n",
        ir::print(module_, temporary.type), temporary.name, temporary.computeCost, element,
        counted(temporary.readers, "pass"), element * temporary.readers);
  }

  void printStack(const Kernel& kernel, const Stack& stack) {
    std::vector<std::string> names;
    for (const ArgumentPlane& plane : stack.layers) {
      const KernelParam& param = kernel.params[plane.argument];
      const bool isWhole = param.type.isArithmetic();
      names.push_back(isWhole ? param.name : fmt::format("{} (plane {})", param.name, plane.plane));
    }
    text_ += wrapLine(fmt::format("  planes of {} that share a texture unit: {}",
                                  ir::print(module_, stack.type), join(names, ", ")),
                      100, 4) +
             "\n";
  }

  void printLoop(const LoopNote& loop) {
    const std::string rounds =
        loop.tripCount ? counted(static_cast<std::size_t>(*loop.tripCount), "round") : "";
    const std::string what =
        loop.whyNot.empty() ? rounds + ", unrolled" : "not unrolled, because " + loop.whyNot;
    text_ += wrapLine(fmt::format("  loop in line {}: {}", loop.loc.line, what), 100, 4) + "\n";
  }

  // ---- reduces ----------------------------------------------------------------------------------

  /// Prints how a stream of 1024 x 1024 elements is folded to a value.
  void printReduce() {
    sk::assemble::RegionLayout input;
    input.extent = {1024, 1024, 1, 1};
    const auto passes =
        sk::assemble::planReduction(input, sk::assemble::valueLayout(), {.texture = {16384, 256}});
    text_ += counted(passes.size(), "pass") + " for 1024 x 1024 elements to a value\n";
    std::int64_t left = sk::assemble::elements(input.extent);
    for (std::size_t i = 0; i < passes.size(); ++i) {
      std::int64_t runs = 0;
      for (const sk::assemble::Rect& rect : passes[i].draws) {
        runs += std::int64_t{rect.width} * rect.height;
      }
      text_ += fmt::format("  pass {}: folds {} elements to {}\n", i + 1, left, runs);
      left = runs;
    }
  }

  /// Prints how a stream of 2^20 elements is scanned.
  void printScan() {
    constexpr std::int32_t count = 1 << 20;
    const sk::assemble::ReduceLimits limits{.texture = {16384, 256}, .fanIn = sk::assemble::scanRun};
    const auto elements =
        sk::assemble::linearLayout(count, *sk::assemble::linearTexture(count, limits.texture));
    const sk::assemble::ScanPlan plan =
        sk::assemble::planScan(elements, elements, limits, {count, 1}, {}, false);
    text_ += counted(plan.folds.size() + plan.scans.size(), "pass") + " for 2^20 elements\n";
    std::int32_t left = count;
    std::size_t pass = 0;
    for (std::size_t i = 0; i < plan.folds.size(); ++i) {
      const std::int32_t runs = (left - 1) / sk::assemble::scanRun + 1;
      text_ += fmt::format("  pass {}: folds {} elements to {}\n", ++pass, left, runs);
      left = runs;
    }
    for (std::size_t i = plan.scans.size(); i-- > 0; left *= sk::assemble::scanRun)
      text_ += fmt::format("  pass {}: scans {} in runs of {}\n", ++pass, left, sk::assemble::scanRun);
  }

  const Module& module_;
  std::string_view name_;
  const Limits limits_;
  std::string text_;
};

}  // namespace

std::string planListing(const Module& module, std::string_view name, const Limits& limits) {
  return PlanPrinter(module, name, limits).print();
}

}  // namespace skc::driver
