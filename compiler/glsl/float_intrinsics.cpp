// SPDX-License-Identifier: MIT
#include "glsl/float_intrinsics.hpp"

#include <algorithm>
#include <array>

namespace skc::emit {
namespace {

using Defined = sk::program::Intrinsic;

struct FloatIntrinsic {
  ir::Intrinsic intrinsic;
  Defined defined;
  std::string_view enumerator;
};

#define SKC_DEFINED(Name) \
  FloatIntrinsic { ir::Intrinsic::Name, Defined::Name, #Name }
#define SKC_SYNONYM(Name, Other) \
  FloatIntrinsic { ir::Intrinsic::Name, Defined::Other, #Other }
constexpr std::array floatIntrinsics = {
    SKC_DEFINED(Sin),      SKC_DEFINED(Cos),         SKC_DEFINED(Tan),   SKC_DEFINED(Asin),
    SKC_DEFINED(Acos),     SKC_DEFINED(Atan),        SKC_DEFINED(Atan2), SKC_SYNONYM(AtanYX, Atan2),
    SKC_DEFINED(Sinh),     SKC_DEFINED(Cosh),        SKC_DEFINED(Tanh),  SKC_DEFINED(Asinh),
    SKC_DEFINED(Acosh),    SKC_DEFINED(Atanh),       SKC_DEFINED(Exp),   SKC_DEFINED(Exp2),
    SKC_DEFINED(Log),      SKC_DEFINED(Log2),        SKC_DEFINED(Log10), SKC_DEFINED(Pow),
    SKC_DEFINED(Hypot),    SKC_DEFINED(Log1p),       SKC_DEFINED(Expm1), SKC_DEFINED(Cbrt),
    SKC_DEFINED(Erf),      SKC_DEFINED(Erfc),        SKC_DEFINED(Min),   SKC_SYNONYM(Fmin, Min),
    SKC_DEFINED(Max),      SKC_SYNONYM(Fmax, Max),   SKC_DEFINED(Clamp), SKC_DEFINED(Saturate),
    SKC_DEFINED(Fract),    SKC_SYNONYM(Frac, Fract), SKC_DEFINED(Mod),   SKC_DEFINED(Fmod),
    SKC_DEFINED(Mix),      SKC_SYNONYM(Lerp, Mix),   SKC_DEFINED(Step),  SKC_DEFINED(Smoothstep),
    SKC_DEFINED(Sign),     SKC_DEFINED(Isnan),       SKC_DEFINED(Isinf), SKC_DEFINED(Length),
    SKC_DEFINED(Distance), SKC_DEFINED(Normalize),
};
#undef SKC_DEFINED
#undef SKC_SYNONYM

}  // namespace

std::optional<Defined> definedIntrinsic(const ir::IntrinsicCall& call) {
  const auto isFloat = [](const ir::ExprPtr& arg) { return arg->type.arithmeticType().isFloat(); };
  const auto row = std::ranges::find(floatIntrinsics, call.intrinsic, &FloatIntrinsic::intrinsic);
  if (row == floatIntrinsics.end() || !std::ranges::all_of(call.args, isFloat)) return std::nullopt;
  return row->defined;
}

std::optional<Defined> definedOfDoubles(ir::Intrinsic intrinsic) {
  const auto row = std::ranges::find(floatIntrinsics, intrinsic, &FloatIntrinsic::intrinsic);
  if (row == floatIntrinsics.end() || row->defined > Defined::Pow) return std::nullopt;
  return row->defined;
}

std::string_view enumerator(Defined intrinsic) {
  return std::ranges::find(floatIntrinsics, intrinsic, &FloatIntrinsic::defined)->enumerator;
}

std::string functionName(Defined intrinsic) {
  std::string name = "sk_" + std::string(enumerator(intrinsic));
  name[3] = static_cast<char>(name[3] - 'A' + 'a');
  return name;
}

}  // namespace skc::emit
