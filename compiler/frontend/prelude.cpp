// SPDX-License-Identifier: MIT
#include "frontend/prelude.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include <clang/AST/DeclTemplate.h>
#include <fmt/format.h>

#include "ir/intrinsics.hpp"
#include "ir/print.hpp"

namespace skc::frontend {
namespace {

struct VectorFamily {
  std::string_view scalar;    ///< in .sk
  std::string_view element;   ///< Clang's type
  std::string_view arithmetic;   ///< arithmetic type of intrinsics
};

// In Clang, vectors of `bool` have no swizzles. Their components are therefore char32_t, which nothing else
// uses and which has the size of the masks that vector comparisons give.
constexpr std::array<VectorFamily, 12> families = {{{"float", "float", "float"},
                                                    {"double", "double", "double"},
                                                    {"int", "int", "int"},
                                                    {"uint", "unsigned", "uint"},
                                                    {"long", "long", "long"},
                                                    {"ulong", "unsigned long", "ulong"},
                                                    {"bool", "char32_t", "bool"},
                                                    {"half", "__fp16", "float"},
                                                    {"char", "char", "int"},
                                                    {"uchar", "unsigned char", "int"},
                                                    {"short", "short", "int"},
                                                    {"ushort", "unsigned short", "int"}}};

// Clang has no normalized types: they are classes that convert to and from float.
constexpr std::array<std::string_view, 4> normalized = {"unorm8", "snorm8", "unorm16", "snorm16"};

/// True if arguments that match this letter of a signature help determine the result type.
bool countsForResult(char letter) {
  return std::string_view("FfVDdNnSZQR").find(letter) != std::string_view::npos;
}

/// The letters at each parameter position, over all signatures.
std::vector<std::string> lettersByPosition(const std::vector<std::string_view>& signatures) {
  std::vector<std::string> positions;
  for (std::string_view text : signatures) {
    std::size_t position = 0;
    for (char c : text.substr(text.find('('))) {
      if (c == '(' || c == ')' || c == ',') continue;
      if (positions.size() <= position) positions.emplace_back();
      positions[position++] += c;
    }
  }
  return positions;
}

/// Declares an intrinsic; `pow`, F(F,F): "template <class A, class B> __sk_F<A, B> pow(A, B);"
std::string declare(std::string_view name, const std::vector<std::string_view>& signatures) {
  const char result = signatures.front().front();
  const std::vector<std::string> positions = lettersByPosition(signatures);
  if (result == 'w') return fmt::format("float3 {0}(float3, float3); double3 {0}(double3, double3);\n", name);
  std::string parameters, arguments, deciding;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const char type = static_cast<char>('A' + i);
    bool counts = true;
    for (char letter : positions[i]) {
      // asfloat takes int or uint; the weight or mask of mix does not affect the result type
      counts = counts && (countsForResult(letter) || (positions.size() == 1));
    }
    parameters += fmt::format("{}class {}", i == 0 ? "" : ", ", type);
    arguments += fmt::format("{}{}", i == 0 ? "" : ", ", type);
    if (counts) deciding += fmt::format("{}{}", deciding.empty() ? "" : ", ", type);
  }
  std::string type;
  switch (result) {
    case 'F': type = fmt::format("__sk_F<{}>", deciding); break;
    case 'I': type = fmt::format("__sk_I<{}>", deciding); break;
    case 'U': type = fmt::format("__sk_U<{}>", deciding); break;
    case 'B':
    case 'C': type = fmt::format("__sk_B<{}>", deciding); break;
    case 'N':
    case 'S':
    case 'Z': type = fmt::format("__sk_N<{}>", deciding); break;
    case 'X': type = "A"; break;
    case 'f': type = positions[0] == "X" ? "float" : fmt::format("__sk_f<{}>", deciding); break;
    case 'b': type = "bool"; break;
  }
  return fmt::format("template <{}> {} {}({});\n", parameters, type, name, arguments);
}

std::string vectorTypes() {
  std::string text =
      "typedef unsigned uint; typedef unsigned long ulong; typedef __fp16 half; typedef unsigned char uchar; "
      "typedef unsigned short ushort;\n";
  for (const VectorFamily& family : families) {
    for (int width = 2; width <= 4; ++width) {
      text += fmt::format(
          "typedef {0} {1}{2} __attribute__((ext_vector_type({2})));\n"
          "template <class... A> {1}{2} __sk_make_{1}{2}(A...);\n",
          family.element, family.scalar, width);
    }
  }
  return text;
}

/// A class for values that are floats, or vectors of floats, stored with fewer bits.
std::string normalizedType(std::string_view name, std::string_view arithmetic) {
  return fmt::format(
      "struct {0} {{\n"
      "  {0}() = default; constexpr {0}({1}) {{}} operator {1}() const;\n"
      "  void operator+=({1}); void operator-=({1}); void operator*=({1}); void operator/=({1});\n}};\n",
      name, arithmetic);
}

std::string normalizedTypes() {
  std::string text;
  for (const std::string_view name : normalized) {
    text += normalizedType(name, "float");
    for (int width = 2; width <= 4; ++width) {
      const std::string vector = fmt::format("{}x{}", name, width);
      text += normalizedType(vector, fmt::format("float{}", width));
      text += fmt::format("template <class... A> {0} __sk_make_{0}(A...);\n", vector);
    }
  }
  return text;
}

/// Matrices are classes, because Clang's own have no rows. Lowering knows what their constructors and
/// operators mean; the empty bodies only serve constants. `__sk_row2` is a row in braces or a float2.
std::string matrixTypes() {
  std::string text;
  for (int size = 2; size <= 4; ++size) {
    const auto list = [](std::string_view type, int count) {
      std::string parameters(type);
      for (int i = 1; i < count; ++i) fmt::format_to(std::back_inserter(parameters), ", {}", type);
      return parameters;
    };
    const std::string m = fmt::format("float{0}x{0}", size), row = fmt::format("__sk_row{}", size);
    text += fmt::format("struct {0} {{ constexpr {0}(float{1}) {{}} constexpr {0}({2}) {{}} }};\n", row, size,
                        list("float", size));
    text += fmt::format(
        "struct {0} {{\n  {0}() = default; constexpr {0}({2}) {{}} constexpr {0}({3}) {{}}\n"
        "  float{1}& operator[](int); float{1} operator[](int) const;\n"
        "  float{1}& operator[](uint); float{1} operator[](uint) const;\n"
        "  float{1}& operator[](long); float{1} operator[](long) const;\n"
        "  float{1}& operator[](ulong); float{1} operator[](ulong) const;\n"
        "  void operator+=({0}); void operator-=({0}); void operator*=({0}); void operator*=(float);\n"
        "  void operator/=(float);\n}};\n",
        m, size, list(row, size), list("float", size * size));
    for (const std::string_view signature : {"+({0}, {0})", "-({0}, {0})", "*({0}, {0})", "*({0}, float)",
                                             "*(float, {0})", "/({0}, float)", "-({0})"}) {
      text += "constexpr " + m + " operator" + fmt::format(fmt::runtime(signature), m) + " { return {}; }\n";
    }
    text += fmt::format(
        "float{1} operator*({0}, float{1}); bool operator==({0}, {0});\n"
        "template <class... A> constexpr {0} __sk_make_{0}(A...) {{ return {{}}; }}\n",
        m, size);
  }
  return text;
}

/// __sk_traits<T>: F, I, U and B are the floating-point, int, uint and bool types of T's width, f is F's
/// component, and N is T's arithmetic type. F is float, except that double stays double. Other types have none
/// of them, so that intrinsics leave their arguments to overloads of the program's own.
std::string typeTraits() {
  std::string text = "template <class T> struct __sk_traits {};\n";
  for (const VectorFamily& family : families) {
    for (int width = 1; width <= 4; ++width) {
      const std::string suffix = width == 1 ? "" : std::to_string(width);
      const std::string_view real = family.scalar == "double" ? "double" : "float";
      text += fmt::format(
          "template <> struct __sk_traits<{0}{1}> {{ using F = {3}{1}; using f = {3}; using I = int{1}; "
          "using U = uint{1}; using B = bool{1}; using N = {2}{1}; }};\n",
          family.scalar, suffix, family.arithmetic, real);
    }
  }
  for (const std::string_view name : normalized) {
    text += fmt::format("template <> struct __sk_traits<{0}> : __sk_traits<float> {{}};\n", name);
    for (int width = 2; width <= 4; ++width) {
      text +=
          fmt::format("template <> struct __sk_traits<{0}x{1}> : __sk_traits<float{1}> {{}};\n", name, width);
    }
  }
  text +=
      "template <> struct __sk_traits<char32_t> : __sk_traits<bool> {};\n"
      "template <> struct __sk_traits<signed char> : __sk_traits<char> {};\n"
      "template <> struct __sk_traits<long long> : __sk_traits<long> {};\n"
      "template <> struct __sk_traits<unsigned long long> : __sk_traits<ulong> {};\n"
      "template <class... A> using __sk_sum = __sk_traits<decltype((A() + ...))>;\n"
      "template <class... A> using __sk_F = typename __sk_sum<A...>::F;\n"
      "template <class... A> using __sk_f = decltype((typename __sk_traits<A>::f() + ...));\n"
      "template <class... A> using __sk_I = typename __sk_sum<A...>::I;\n"
      "template <class... A> using __sk_U = typename __sk_sum<A...>::U;\n"
      "template <class... A> using __sk_B = typename __sk_sum<A...>::B;\n"
      "template <class... A> using __sk_N = typename __sk_traits<decltype((A() + ...))>::N;\n";
  return text;
}

// A pipeline passes its streams to gathers: to Clang, they are elements.
constexpr std::string_view gathersAndStreams = R"(
template <class T> struct __sk_element { using type = T; };
template <class T, unsigned long n> struct __sk_element<T[n]> { using type = const T (&)[n]; };
template <class T> using __sk_read = typename __sk_element<T>::type;
template <class T, int rank> struct stream_gather;
template <class T> using gather_1d = stream_gather<T, 1>;
template <class T> using gather_2d = stream_gather<T, 2>;
template <class T> using gather_3d = stream_gather<T, 3>;
template <class T> using gather_4d = stream_gather<T, 4>;
template <class T> struct stream_gather<T, 1> {
  stream_gather() = default; template <class U> requires (__is_same(U, T)) stream_gather(const U&);
  __sk_read<T> operator[](int) const; __sk_read<T> operator[](uint) const; __sk_read<T> operator[](float) const;
  __sk_read<T> operator[](long) const; __sk_read<T> operator[](ulong) const;
};
template <class T> struct stream_gather<T, 2> {
  stream_gather() = default; template <class U> requires (__is_same(U, T)) stream_gather(const U&);
  gather_1d<T> operator[](int) const; gather_1d<T> operator[](uint) const;
  gather_1d<T> operator[](long) const; gather_1d<T> operator[](ulong) const;
  gather_1d<T> operator[](float) const; __sk_read<T> operator[](int2) const; __sk_read<T> operator[](float2) const;
};
template <class T> struct stream_gather<T, 3> {
  stream_gather() = default; template <class U> requires (__is_same(U, T)) stream_gather(const U&);
  gather_2d<T> operator[](int) const; gather_2d<T> operator[](uint) const;
  gather_2d<T> operator[](long) const; gather_2d<T> operator[](ulong) const;
  gather_2d<T> operator[](float) const; __sk_read<T> operator[](int3) const; __sk_read<T> operator[](float3) const;
};
template <class T> struct stream_gather<T, 4> {
  stream_gather() = default; template <class U> requires (__is_same(U, T)) stream_gather(const U&);
  gather_3d<T> operator[](int) const; gather_3d<T> operator[](uint) const;
  gather_3d<T> operator[](long) const; gather_3d<T> operator[](ulong) const;
  gather_3d<T> operator[](float) const; __sk_read<T> operator[](int4) const; __sk_read<T> operator[](float4) const;
};
template <class T, int rank> requires (rank >= 1 && rank <= 4) using gather = stream_gather<T, rank>;
template <int rank> struct __sk_index;
template <> struct __sk_index<1> { using type = int; };
template <> struct __sk_index<2> { using type = int2; };
template <> struct __sk_index<3> { using type = int3; };
template <> struct __sk_index<4> { using type = int4; };
template <int rank> requires (rank >= 1 && rank <= 4) using index = typename __sk_index<rank>::type;
template <int rank> requires (rank >= 1 && rank <= 4) typename __sk_index<rank>::type axis(int d);
template <int rank, class... A> requires (rank >= 1 && rank <= 4) typename __sk_index<rank>::type __sk_make_index(A...);
template <class T> __sk_read<T> neighbor(gather_1d<T> a, int dx);
template <class T> __sk_read<T> neighbor(gather_2d<T> a, int dx, int dy = 0);
template <class T> __sk_read<T> neighbor(gather_2d<T> a, int2 offset);
template <class T> __sk_read<T> neighbor(gather_3d<T> a, int dx, int dy = 0, int dz = 0);
template <class T> __sk_read<T> neighbor(gather_3d<T> a, int3 offset);
template <class T> __sk_read<T> neighbor(gather_4d<T> a, int dx, int dy = 0, int dz = 0, int dw = 0);
template <class T> __sk_read<T> neighbor(gather_4d<T> a, int4 offset);
template <class...> using __sk_void = void;
template <class T, class = void> struct __sk_sampled { using type = float; };
template <class T> struct __sk_sampled<T, __sk_void<typename __sk_traits<T>::F>> {
  using type = typename __sk_traits<T>::F;
};
template <class T> typename __sk_sampled<T>::type sample(gather_1d<T> a, float position);
template <class T> typename __sk_sampled<T>::type sample(gather_2d<T> a, float2 position);
template <class T> typename __sk_sampled<T>::type sample(gather_3d<T> a, float3 position);
template <class T> typename __sk_sampled<T>::type sample(gather_4d<T> a, float4 position);
template <class T> int4 indexof(const T& stream);
template <class T> int4 extentof(const T& stream);
template <int rank, class T> typename __sk_index<rank>::type indexof(const T& stream);
template <int rank, class T> typename __sk_index<rank>::type extentof(const T& stream);
int4 indexof();
int4 extentof();
template <int rank> typename __sk_index<rank>::type indexof();
template <int rank> typename __sk_index<rank>::type extentof();
template <class T> struct scatter_1d {
  T& operator[](int) const; T& operator[](uint) const; T& operator[](float) const;
  T& operator[](long) const; T& operator[](ulong) const;
};
template <class T> struct scatter_2d {
  scatter_1d<T> operator[](int) const; scatter_1d<T> operator[](uint) const;
  scatter_1d<T> operator[](long) const; scatter_1d<T> operator[](ulong) const;
  scatter_1d<T> operator[](float) const; T& operator[](int2) const; T& operator[](float2) const;
};
template <class T> struct scatter_3d {
  scatter_2d<T> operator[](int) const; scatter_2d<T> operator[](uint) const;
  scatter_2d<T> operator[](long) const; scatter_2d<T> operator[](ulong) const;
  scatter_2d<T> operator[](float) const; T& operator[](int3) const; T& operator[](float3) const;
};
template <class T> struct scatter_4d {
  scatter_3d<T> operator[](int) const; scatter_3d<T> operator[](uint) const;
  scatter_3d<T> operator[](long) const; scatter_3d<T> operator[](ulong) const;
  scatter_3d<T> operator[](float) const; T& operator[](int4) const; T& operator[](float4) const;
};
template <class T> struct variable_output {
  variable_output() = default; template <class U> requires (__is_same(U, T)) variable_output(const U&);
  void operator=(const T&) = delete("variable_output"); };
template <class T> struct __sk_same { using type = T; };
template <class T> void push(variable_output<T> r, typename __sk_same<T>::type value);
void printf(const char*, ...) __attribute__((format(printf, 1, 2)));
void __sk_failed();
constexpr void assert(bool condition) { if (!condition) __sk_failed(); }
template <class M, class A, class B> decltype(A() + B()) select(M condition, A yes, B no);
template <class T> T select(bool condition, T yes, T no);
template <class T> void sincos(T x, T& sine, T& cosine);
template <class T> T modf(T x, T& whole);
template <class T> T frexp(T x, __sk_I<T>& exponent);
)";

std::string intrinsics() {
  // One declaration for each name and number of arguments, covering the signatures of all such rows.
  std::map<std::pair<std::string_view, std::size_t>, std::vector<std::string_view>> overloads;
#define SKC_INTRINSIC(Name, spelling, signatures, library, native, glsl, polyfill) \
  {                                                                                \
    std::string_view all = signatures;                                             \
    while (!all.empty()) {                                                         \
      std::string_view one = all.substr(0, all.find(' '));                         \
      all.remove_prefix(std::min(all.size(), one.size() + 1));                     \
      std::size_t arity = 1;                                                       \
      for (char c : one) arity += c == ',';                                        \
      overloads[{spelling, arity}].push_back(one);                                 \
    }                                                                              \
  }
#include "ir/intrinsics.def"
#undef SKC_INTRINSIC
  std::string text;
  for (const auto& [key, signatures] : overloads) {
    if (!key.first.empty()) text += declare(key.first, signatures);
  }
  return text;
}

}  // namespace

std::string preludeText() {
  return fmt::format("# 1 \"sk-prelude\" 1 3\n{}{}{}{}{}{}# 1 \"<command line>\" 2\n", vectorTypes(),
                     normalizedTypes(), matrixTypes(), typeTraits(), gathersAndStreams, intrinsics());
}

std::string typesHeaderText() {
  std::string text = "#pragma GCC system_header\nnamespace sk {\nusing ::half;\n";
  const auto add = [&](const std::string& name) {
    text += fmt::format("using ::{0};\nusing ::__sk_make_{0};\n", name);
  };
  for (int width = 2; width <= 4; ++width) {
    for (const VectorFamily& family : families) add(fmt::format("{}{}", family.scalar, width));
    for (const std::string_view name : normalized) add(fmt::format("{}x{}", name, width));
    add(fmt::format("float{0}x{0}", width));
  }
  for (const std::string_view name : normalized) text += fmt::format("using ::{};\n", name);
  return text + "}\n";
}

bool isVectorTypeName(std::string_view name) {
  if (name.size() < 4) return false;
  const char width = name.back();
  if (width < '2' || width > '4') return false;
  const std::string_view stem = name.substr(0, name.size() - 1);
  for (const VectorFamily& family : families) {
    if (stem == family.scalar) return true;
  }
  return classType(name) && stem.back() == 'x';
}

std::optional<ir::Type> classType(std::string_view name) {
  constexpr ir::Scalar scalars[] = {ir::Scalar::Unorm8, ir::Scalar::Snorm8, ir::Scalar::Unorm16,
                                    ir::Scalar::Snorm16};
  for (int width = 1; width <= 4; ++width) {
    for (const ir::Scalar scalar : scalars) {
      if (name == ir::spelling(scalar, width)) return ir::Type::of(scalar, width);
    }
    if (width > 1 && name == fmt::format("float{0}x{0}", width)) return ir::Type::matrix(width);
    if (width > 1 && name == fmt::format("__sk_row{}", width)) return ir::Type::of(ir::Scalar::Float, width);
  }
  return std::nullopt;
}

std::string vectorConstructorName(std::string_view name) { return fmt::format("__sk_make_{}", name); }

std::string gatherTemplateName(int rank) { return fmt::format("gather_{}d", rank); }

int gatherRank(const clang::CXXRecordDecl* record) {
  const auto* instance = llvm::dyn_cast_or_null<clang::ClassTemplateSpecializationDecl>(record);
  if (instance == nullptr || instance->getName() != llvm::StringRef(gatherClass)) return 0;
  const clang::TemplateArgumentList& arguments = instance->getTemplateArgs();
  return arguments.size() == 2 ? static_cast<int>(arguments[1].getAsIntegral().getExtValue()) : 0;
}

bool isYielding(std::string_view name) { return name == "gather" || name == "index" || name == "axis"; }

bool isYieldingToTemplates(std::string_view name) {
  constexpr std::string_view names[] = {"cbrt",  "clz",   "ctz",   "erf",   "erfc",
                                        "expm1", "hypot", "log1p", "mulhi", "popcount"};
  return std::ranges::find(names, name) != std::end(names);
}

std::string appendTemplateName(int rank) {
  return rank == 0 ? "variable_output" : fmt::format("scatter_{}d", rank);
}

}  // namespace skc::frontend
