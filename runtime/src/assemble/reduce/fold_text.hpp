// SPDX-License-Identifier: MIT
//
// What the programs of reductions and scans have in common: the parameters of a kernel that folds elements, and calls
// of its entry.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/elements/domain.hpp"
#include "assemble/elements/planes.hpp"
#include "assemble/glsl/program_text.hpp"
#include "assemble/reduce/reduce_program.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

class FoldText {
 protected:
  /// `kernel` is `reduction`'s fold or combine, perhaps with other parameters behind its own.
  FoldText(const Profile& profile, const program::Reduction& reduction, const ReduceVariant& variant,
           const program::Kernel& kernel);
  ~FoldText() = default;
  FoldText(const FoldText&) = delete;
  FoldText& operator=(const FoldText&) = delete;

  // ---- parameters -------------------------------------------------------------------------------

  StreamAccess access(std::size_t i) const {
    return variant_.access.empty() ? StreamAccess{} : variant_.access[i];
  }
  void defineParameters();
  /// The index of the current element in the domain, an ivec4 variable.
  std::string item();
  /// The same in what the fold speaks of, an ivec4 expression.
  std::string seenItem();
  /// The extents of what the fold speaks of, an ivec4 expression.
  std::string seenShape();
  /// The element of an input: of Walk::Index at its own address, else at a texel.
  std::string element(std::size_t i, const Texel& texel);
  /// The texel with a number in the linearised texture that the walk reads.
  Texel numberedTexel(std::string_view number);

  // ---- packed inputs ----------------------------------------------------------------------------

  /// Declares variables for the four elements of a texel of each input; reads them; one of them, `lane` is ".x".
  void declareLanes();
  void fetchLanes(const Texel& texel, std::string_view indent);
  std::string elementOf(std::size_t i, std::string_view lane) const;

  // ---- accumulators -----------------------------------------------------------------------------

  /// The variable that holds an accumulator.
  std::string total(const program::Parameter& accumulator) const { return held(folded_, accumulator); }
  std::string held(std::string_view name, const program::Parameter& accumulator) const;
  void startFromIdentities(std::string_view indent = "");
  /// The identity of an accumulator, which the fold has, also for passes that combine.
  std::string_view identityOf(const program::Parameter& accumulator) const;
  /// Declares the accumulators. Each starts as the input at its position among the accumulators, of which
  /// valueOf(i) is the first value; `i` is a parameter.
  void startFromElements(const std::function<std::string(std::size_t i)>& valueOf);

  /// The argument for parameter i, the k-th input.
  using ElementOf = std::function<std::string(std::size_t i, std::size_t k)>;
  /// A call of the entry of a kernel, with its arguments in order.
  std::string calling(const program::Kernel& kernel, const ElementOf& inputElement);

  /// The variable that receives an output of the fold.
  std::string output(const program::Parameter& parameter);

  // ---- work groups ------------------------------------------------------------------------------

  /// Declares the accumulators of all invocations of a group.
  void declareShared();
  /// Combines the accumulators of the first sk_runs invocations, in order, into those of the first one. sk_i is the
  /// number of the invocation. If there are several `blocks`, a power of two, invocation i combines those of i + blocks,
  /// i + 2 * blocks and so on.
  void foldShared(int blocks = 1);

  // ---- statements -------------------------------------------------------------------------------

  void integers(std::initializer_list<std::string_view> uniforms);
  void vectors(std::initializer_list<std::string_view> uniforms);
  void statement(std::string_view line) { program_.statement(margin_ + std::string(line)); }
  /// The index with this number in a box of ReduceVariant::axes dimensions, given the uniform with its strides.
  std::string unravel(std::string_view number, std::string_view strides);
  /// Stores the accumulators, and returns the program.
  std::string finish(const std::vector<program::Parameter>& written, std::string_view comment) {
    for (const program::Parameter& parameter : written) store(program_, parameter, total(parameter));
    return finish(comment);
  }
  /// Returns the program, whose outputs have been stored.
  std::string finish(std::string_view comment);

  const Profile& profile_;
  const program::Reduction& reduction_;
  const ReduceVariant& variant_;
  const HeldKernel held_;
  const program::Kernel& kernel_;
  std::vector<const program::Parameter*> inputs_;
  std::vector<const program::Parameter*> accumulators_;
  std::vector<std::string> arguments_;  ///< those that are the same for all elements, and iterators
  ProgramText program_;
  DomainText domain_;
  std::string margin_;  ///< before every statement
  std::string_view folded_ = "sk_total";  ///< the name of the accumulators that are being folded

 private:
  std::string sharedName(const program::Parameter& accumulator) const;
  std::string itemPosition(int components);
  /// What getters of indices of inputs within their regions are called.
  std::string_view indexGetter() const { return variant_.placed ? "within" : "index"; }
  void defineParameter(const program::Parameter& parameter, const StreamAccess& access);
};

}  // namespace sk::assemble
