// SPDX-License-Identifier: MIT
#include "program/constants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "glsl/type_names.hpp"
#include "ir/print.hpp"
#include "program/cpp_literals.hpp"
#include "program/cpp_names.hpp"
#include "program/schema.hpp"
#include "support/namer.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

// ---- defaults ---------------------------------------------------------------------------------------

template <class M>
bool isSame(const M& a, const M& b);

template <class M>
bool areListsSame(std::span<const M> a, std::span<const M> b) {
  return a.empty() && b.empty();  // defaults are empty
}

/// Whether two values of a member are the same, one of which is its default.
template <class M>
bool isSame(const M& a, const M& b) {
  if constexpr (Described<M>) {
    const auto isMemberSame = [&](const auto& member) {
      if constexpr (requires { member.pointer; })
        return isSame(a.*member.pointer, b.*member.pointer);
      else
        return a.*member.first == b.*member.first;
    };
    return std::apply([&](const auto&... member) { return (isMemberSame(member) && ...); }, Members<M>::list);
  } else if constexpr (requires { areListsSame(a, b); }) {
    return areListsSame(a, b);
  } else {
    return a == b;
  }
}

// ---- types ------------------------------------------------------------------------------------------

template <class T>
std::string typeName() {
  if constexpr (Described<T>)
    return std::string(Members<T>::type);
  else if constexpr (std::same_as<T, const p::Element*>)
    return "const Element*";
  else
    return "std::uint8_t";
}

/// What follows a name in that of a constant of this type.
template <class T>
std::string constantName(const std::string& name) {
  if constexpr (std::same_as<T, p::Kernel>) return name + Part::Kernel;
  if constexpr (std::same_as<T, p::Reduction>) return name + Part::Reduction;
  if constexpr (std::same_as<T, p::Table>) return name + Part::Table;
  if constexpr (std::same_as<T, p::Element>) return name + Part::Element;
  return name;
}

/// Types whose values are constants of their own wherever they are members.
template <class T>
constexpr bool hasOwnConstants = std::same_as<T, p::Kernel> || std::same_as<T, p::Reduction>;

/// Types with one member in a line.
template <class T>
constexpr bool isLong = std::same_as<T, p::Kernel> || std::same_as<T, p::Reduction>;

class ConstantWriter {
 public:
  ConstantWriter(const ir::Module& module, const Program& program, const std::vector<std::string>& names,
                 const NativeRequests& requests)
      : module_(module), types_(module), program_(program), requests_(requests) {
    for (std::size_t i = 0; i < names.size(); ++i) prefixes_.emplace(program.units()[i].id, names[i]);
    const std::vector<std::string> tables = tableNames(module);
    for (std::size_t i = 0; i < tables.size(); ++i)
      if (program.tables()[i] != nullptr) tables_.emplace(program.tables()[i], tables[i]);
  }

  void add(const Unit& unit) {
    const std::string& name = prefixes_.at(unit.id);
    constantOf(unit.kernel, name);
    if (unit.reduction != nullptr) constantOf(*unit.reduction, name);
  }

  std::string take() { return std::move(text_); }

 private:
  // ---- constants ------------------------------------------------------------------------------------

  /// Prints a constant with the prefix `name`, unless it is there already, and returns its name.
  template <Described T>
  std::string constantOf(const T& value, const std::string& name) {
    std::string constant = constantName<T>(name);
    std::vector<std::string> members = membersOf(value, name);
    const std::string head = fmt::format("constexpr {} {} = {{", Members<T>::type, constant);
    if (isLong<T>)
      text_ += head + "\n    " + join(members, ",\n    ") + "};\n\n";
    else
      text_ += wrapLine(head + join(members, ", ") + "};", 100, 4) + "\n\n";
    return constant;
  }

  /// All copies of a kernel's descriptor are one constant. A unit's has the unit's name, wherever it is needed first.
  std::string constantOf(const p::Kernel& kernel, const std::string& name) {
    const ir::KernelId id = program_.idOf(kernel);
    if (const auto known = kernels_.find(id); known != kernels_.end()) return known->second;
    const auto unit = prefixes_.find(id);
    const std::string constant = constantOf<p::Kernel>(kernel, unit == prefixes_.end() ? name : unit->second);
    return kernels_.emplace(id, constant).first->second;
  }

  std::string constantOf(const p::Table& table, const std::string&) {
    const std::string& name = tables_.at(&table);
    if (printed_.emplace(&table, name).second) return constantOf<p::Table>(table, name);
    return constantName<p::Table>(name);
  }

  /// Elements that C++ has types of have traits. Others are those of arrays, which cannot be elements of streams, and of structs that a
  /// transform has made.
  std::string referenceTo(const p::Element& element) {
    const ir::Type type = program_.typeOf(element);
    const bool isStruct = type.kind == ir::Type::Kind::Struct;
    if (type.kind == ir::Type::Kind::Array || (isStruct && module_.structs[type.index].isSynthesized)) {
      const auto [known, isNew] = printed_.try_emplace(&element);
      if (isNew) {
        const std::string name =
            isStruct ? synthesizedStructName(types_.structName(type.index)) : arrayName(arrays_++);
        known->second = constantOf<p::Element>(element, name);
      }
      return "&" + known->second;
    }
    const std::string name = type.isVector() ? ir::spelling(type.scalar, type.width) : cppType(module_, type);
    return fmt::format("&ElementTraits<{}{}>::element()", isStruct ? "::" : "", name);
  }

  // ---- members --------------------------------------------------------------------------------------

  /// The initializers of a descriptor's members, after printing what they refer to.
  template <class T>
  std::vector<std::string> membersOf(const T& value, const std::string& name) {
    std::vector<std::string> members;
    std::apply([&](const auto&... member) { (addMember(members, value, member, name), ...); },
               Members<T>::list);
    return members;
  }

  template <class T, class M>
  void addMember(std::vector<std::string>& members, const T& value, const Member<T, M>& member,
                 const std::string& name) {
    members.push_back(initializer(member.name, textOf(value.*member.pointer, name, member.part)));
  }
  template <class T, class M>
  void addMember(std::vector<std::string>& members, const T& value, const Option<T, M>& member,
                 const std::string& name) {
    if (isSame(value.*member.pointer, T{}.*member.pointer)) return;
    members.push_back(initializer(member.name, textOf(value.*member.pointer, name, member.part)));
  }
  template <class T, class M>
  void addMember(std::vector<std::string>& members, const T& value, const CppOption<T, M>& member,
                 const std::string& name) {
    addMember(members, value, Option<T, M>{member.name, member.pointer, member.part}, name);
  }
  template <class T, class M, class N>
  void addMember(std::vector<std::string>& members, const T& value, const CountedOption<T, M, N>& member,
                 const std::string& name) {
    const std::span<const M> list(value.*member.first, value.*member.number);
    if (list.empty()) return;
    members.push_back(initializer(member.name, textOf(list, name, member.part)));
    members.push_back(initializer(member.numberName, std::to_string(list.size())));
  }
  template <class T, class M>
  void addMember(std::vector<std::string>&, const T&, const OmittedMember<T, M>&, const std::string&) {}
  /// Constants refer to native code by its symbol.
  void addMember(std::vector<std::string>& members, const p::Kernel& kernel,
                 const CppOption<p::Kernel, const sk::native::Code*>& member, const std::string&) {
    const std::string_view symbol = requests_.symbolOf(program_.idOf(kernel));
    if (!symbol.empty()) members.push_back(initializer(member.name, fmt::format("&native::{}", symbol)));
  }

  static std::string initializer(std::string_view member, const std::string& value) {
    return fmt::format(".{} = {}", member, value);
  }

  // ---- values ---------------------------------------------------------------------------------------
  //
  // `name` is the prefix of the constant that has the value, `part` the word that the schema adds to it for what the value refers to.

  using Word = std::optional<Part>;

  static std::string with(const std::string& name, Word part) { return part ? name + *part : name; }

  /// Programs are constants of their own, as raw strings. The length of a literal with a suffix is known; compilers would
  /// count that of a plain string_view one character at a time.
  std::string textOf(std::string_view value, const std::string& name, Word part) {
    if (!part) return quoted(value);
    if (value.empty()) return "{}";
    text_ +=
        fmt::format("constexpr std::string_view {} =\n    {}sv;\n\n", with(name, part), rawString(value));
    return with(name, part);
  }
  std::string textOf(bool value, const std::string&, Word) { return value ? "true" : "false"; }
  std::string textOf(float value, const std::string&, Word) { return floatLiteral(value); }
  /// Writes one end of a range, which may be infinite.
  std::string textOf(double value, const std::string&, Word) {
    if (std::isinf(value)) return value < 0 ? "-ValueRange::infinity" : "ValueRange::infinity";
    return doubleLiteral(value);
  }
  template <std::integral T>
  std::string textOf(T value, const std::string&, Word) {
    return fmt::format("{}{}", value, std::cmp_greater(value, INT32_MAX) && std::is_unsigned_v<T> ? "u" : "");
  }
  template <class E>
    requires std::is_enum_v<E>
  std::string textOf(E value, const std::string&, Word) {
    std::string enumerator(nameOf(value));
    enumerator[0] = static_cast<char>(enumerator[0] - 'a' + 'A');
    return fmt::format("{}::{}", enumeration<E>.type, enumerator);
  }
  template <class T, std::size_t Count>
  std::string textOf(const std::array<T, Count>& values, const std::string& name, Word part) {
    std::size_t used = Count;
    while (used > 0 && values[used - 1] == T{}) --used;
    std::vector<std::string> items;
    for (std::size_t i = 0; i < used; ++i) items.push_back(textOf(values[i], name, part));
    return "{" + join(items, ", ") + "}";
  }
  template <Described T>
  std::string textOf(const T& value, const std::string& name, Word part) {
    if constexpr (hasOwnConstants<T>) return constantOf(value, with(name, part));
    return "{" + join(membersOf(value, with(name, part)), ", ") + "}";
  }
  template <class T>
  std::string textOf(const std::optional<T>& value, const std::string& name, Word part) {
    return value ? typeName<T>() + textOf(*value, name, part) : "{}";
  }
  template <class T>
  std::string textOf(const T* value, const std::string& name, Word part) {
    if (value == nullptr) return "nullptr";
    if constexpr (std::same_as<T, p::Element>)
      return referenceTo(*value);
    else
      return "&" + constantOf(*value, with(name, part));
  }
  /// The file's list of sources.
  std::string textOf(std::span<const std::string_view>, const std::string&, Word) { return "sources"; }
  /// The kernels of a file share the list.
  std::string textOf(std::span<const p::Assertion> values, const std::string& name, Word part) {
    const auto [known, isNew] = printed_.try_emplace(values.data());
    if (isNew) known->second = listOf(values, name, part);
    return known->second;
  }
  template <class T>
  std::string textOf(std::span<const T> values, const std::string& name, Word part) {
    return listOf(values, name, part);
  }
  template <class T>
  std::string listOf(std::span<const T> values, const std::string& name, Word part) {
    if (values.empty()) return "{}";
    const std::string list = with(name, part);
    std::vector<std::string> items;
    std::size_t number = 0;
    for (const T& value : values)
      items.push_back(textOf(value, list + std::to_string(++number), std::nullopt));
    text_ += constantList(typeName<std::remove_const_t<T>>(), list, items);
    return list;
  }

  const ir::Module& module_;
  TypeNames types_;
  const Program& program_;
  const NativeRequests& requests_;
  std::map<ir::KernelId, std::string> prefixes_;  ///< of the units
  std::map<const p::Table*, std::string> tables_;  ///< their prefixes
  std::map<ir::KernelId, std::string> kernels_;  ///< constants printed
  std::map<const void*, std::string>
      printed_;  ///< constants of elements and tables, and the list of assertions
  std::size_t arrays_ = 0;  ///< elements of arrays printed
  std::string text_;
};

}  // namespace

std::string constantsText(const ir::Module& module, const Program& program,
                          const std::vector<std::string>& names, const NativeRequests& requests) {
  ConstantWriter writer(module, program, names, requests);
  for (const Unit& unit : program.units()) writer.add(unit);
  return writer.take();
}

std::string constantList(std::string_view type, const std::string& name,
                         const std::vector<std::string>& items) {
  if (items.empty()) return {};
  const std::string head = fmt::format("constexpr {} {}[] = {{", type, name);
  constexpr std::size_t limit = 100;
  std::string line = head + join(items, ", ") + "};";
  if (line.size() <= limit) return line + "\n\n";
  if (items.front().front() != '{') return wrapLine(line, limit, 4) + "\n\n";
  std::string text = head + "\n";
  for (const std::string& item : items) text += wrapLine("    " + item + ",", limit, 5) + "\n";
  return text + "};\n\n";
}

namespace {

using namespace ir;

constexpr std::string_view words[] = {
#define SKC_PART(Word) #Word,
#include "program/constant_parts.def"
#undef SKC_PART
};

/// Prefixes none of which could give a constant the name of another's.
class Prefixes {
 public:
  std::string take(const std::string& wanted) {
    std::string name = unique_.find(wanted, [&](const std::string& n) { return meetsAny(n); });
    known_.insert(name);
    return name;
  }

 private:
  /// True if constants of two prefixes could have the same name, where `rest` is what the longer one has more than the other: it is a
  /// part. A number behind the prefix rules that out, since no part contains an underscore before a digit.
  static bool isPart(std::string_view rest) {
    return startsWithPart(rest) && rest.find('_') == std::string_view::npos;
  }

  bool meetsAny(const std::string& name) const {
    if (known_.contains(name)) return true;
    const std::string_view text = name;
    for (std::size_t size = 0; size < text.size(); ++size) {
      if (isPart(text.substr(size)) && known_.contains(text.substr(0, size))) return true;
    }
    for (auto longer = known_.lower_bound(name); longer != known_.end() && longer->starts_with(name);
         ++longer) {
      if (isPart(std::string_view(*longer).substr(name.size()))) return true;
    }
    return false;
  }

  std::set<std::string, std::less<>> known_;
  UniqueNames unique_;
};

/// Prefixes that no unit has, since theirs have an underscore before a digit only.
std::string ownName(std::string_view name) { return std::string("sk_").append(name); }

}  // namespace

std::span<const std::string_view> partWords() { return words; }

std::string_view wordOf(Part part) { return words[static_cast<std::size_t>(part)]; }

bool startsWithPart(std::string_view text) {
  return std::ranges::any_of(words, [&](std::string_view word) { return text.starts_with(word); });
}

std::vector<std::string> constantNames(const Module& module, const Program& program) {
  Prefixes prefixes;
  std::vector<std::string> names;
  for (const Unit& unit : program.units())
    names.push_back(prefixes.take(camelCase(module.kernels[unit.id].name)));
  return names;
}

std::vector<std::string> tableNames(const Module& module) {
  Prefixes prefixes;
  std::vector<std::string> names;
  for (const Table& table : module.tables) names.push_back(prefixes.take(ownName(camelCase(table.name))));
  return names;
}

std::string exactCombinationName(const Kernel& combine) { return ownName(combine.name); }

std::string arrayName(std::size_t number) { return ownName("array_" + std::to_string(number)); }

std::string synthesizedStructName(const std::string& glslName) { return ownName(glslName); }

}  // namespace skc::emit
