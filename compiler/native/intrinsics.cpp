// SPDX-License-Identifier: MIT
#include "native/intrinsics.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include <llvm/ADT/STLFunctionalExtras.h>
#include <llvm/Support/ErrorHandling.h>

#include "native/intrinsic_functions.hpp"

namespace skc::native {

using namespace ir;

namespace {

using Arguments = std::vector<IntrinsicArgument>;

/// Computes a component of the result from the same component of each argument; missing arguments have no
/// value. `scalar` is the type of the first argument's components.
using ByComponent = llvm::function_ref<Part(Scalar scalar, const Part& x, const Part& y, const Part& z)>;

/// Applies the function to each component; a scalar argument serves for every one.
Parts byComponent(const Lanes& lanes, const Arguments& arguments, ByComponent function) {
  std::size_t width = 1;
  for (const IntrinsicArgument& argument : arguments) width = std::max(width, argument.parts.size());
  Parts result;
  for (std::size_t i = 0; i < width; ++i) {
    std::array<Part, 3> x;
    assert(arguments.size() <= x.size());
    for (std::size_t k = 0; k < arguments.size(); ++k) {
      const Parts& parts = arguments[k].parts;
      x[k] = {lanes.value(parts[parts.size() == 1 ? 0 : i])};
    }
    result.push_back(function(arguments[0].type.scalar, x[0], x[1], x[2]));
  }
  return result;
}

/// Computes the result from all components of the arguments; `n` is the width of the first argument.
using OfVectors = llvm::function_ref<Parts(const Parts& a, const Parts& b, const Parts& c, std::size_t n)>;

Parts ofVectors(const Arguments& arguments, OfVectors function) {
  const Parts none;
  const auto parts = [&](std::size_t i) -> const Parts& {
    return i < arguments.size() ? arguments[i].parts : none;
  };
  return function(parts(0), parts(1), parts(2), arguments[0].type.width);
}
Parts asParts(const Part& part) { return {part}; }
Parts asParts(Parts parts) { return parts; }

Part libm(const ScalarBuilder& f, const char* name, const Part& x, const Part& y) {
  return f.libm(name, y.value == nullptr ? Parts{x} : Parts{x, y});
}

}  // namespace

// The forms of the column `native`.
#define SKC_BY_COMPONENT(...)                                                                           \
  return byComponent(lanes, arguments,                                                                  \
                     [&]([[maybe_unused]] Scalar scalar, const Part& x, [[maybe_unused]] const Part& y, \
                         [[maybe_unused]] const Part& z) -> Part { return __VA_ARGS__; })
#define SKC_NATIVE_Operator(name) SKC_BY_COMPONENT(binary(lanes, BinaryOp::name, scalar, x, y))
#define SKC_NATIVE_Instruction(name) SKC_BY_COMPONENT(f.instruction(llvm::Intrinsic::name, #name, x))
#define SKC_NATIVE_Libm(name) SKC_BY_COMPONENT(libm(f, #name, x, y))
#define SKC_NATIVE_Component(...) SKC_BY_COMPONENT(__VA_ARGS__)
#define SKC_NATIVE_Whole(...)                                                                            \
  return ofVectors(arguments,                                                                            \
                   [&](const Parts& a, [[maybe_unused]] const Parts& b, [[maybe_unused]] const Parts& c, \
                       [[maybe_unused]] std::size_t n) { return asParts(__VA_ARGS__); })
#define SKC_NATIVE_None break

Parts intrinsic(Lanes& lanes, Intrinsic intrinsic, const Arguments& arguments) {
  const ScalarBuilder f(lanes);
  switch (intrinsic) {
#define SKC_INTRINSIC(Name, spelling, signatures, library, native, glsl, polyfill) \
  case Intrinsic::Name: SKC_NATIVE_##native;
#include "ir/intrinsics.def"
#undef SKC_INTRINSIC
  }
  llvm_unreachable("callLibrary() has put a function of the library in its place");
}

}  // namespace skc::native
