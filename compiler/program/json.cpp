// SPDX-License-Identifier: MIT
//
// Kernels and elements that several descriptors refer to are printed once, in tables at the top, and referred to by
// their index there.
#include "program/json.hpp"

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include <nlohmann/json.hpp>

#include "ir/print.hpp"
#include "program/elements.hpp"
#include "program/schema.hpp"
#include "program/stream_structs.hpp"

namespace skc::emit {
namespace {

using Json = nlohmann::ordered_json;

/// A list of distinct objects, each with the index of its first occurrence.
class Shared {
 public:
  std::size_t indexOf(Json&& object) {
    const auto [entry, isNew] = indices_.emplace(object.dump(), list_.size());
    if (isNew) list_.push_back(std::move(object));
    return entry->second;
  }
  Json& list() { return list_; }

 private:
  Json list_ = Json::array();
  std::map<std::string, std::size_t> indices_;
};

class Writer {
 public:
  Writer(const ir::Module& module, const Program& program) : module_(module), program_(program) {}

  Json write(std::string_view fileName) {
    Json callables = Json::array();
    for (const Unit& unit : program_.units()) callables.push_back(callable(unit));
    Json tables = Json::array();
    for (const p::Table* table : program_.tables()) {
      if (table != nullptr) tables.push_back(object(*table));
    }
    return {{"schema", jsonSchema},
            {"file", fileName},
            {"sources", module_.sources},
            {"callables", std::move(callables)},
            {"kernels", std::move(kernels_.list())},
            {"elements", std::move(elements_.list())},
            {"tables", std::move(tables)},
            {"structs", structs()},
            {"bundles", bundles()}};
  }

 private:
  Json callable(const Unit& unit) {
    const std::string_view kind = unit.isScan ? "scan" : unit.reduction != nullptr ? "reduce" : "kernel";
    Json bundles = Json::array();
    for (const ir::BundleParam& bundle : module_.kernels[unit.id].bundles) {
      bundles.push_back(
          {{"name", bundle.name}, {"type", bundle.type}, {"first", bundle.first}, {"count", bundle.count}});
    }
    return {{"kind", kind},
            {"kernel", value(unit.kernel)},
            {"reduction", value(unit.reduction)},
            {"bundles", std::move(bundles)}};
  }

  Json bundles() const {
    Json list = Json::array();
    for (const ir::BundleType& bundle : module_.bundleTypes) {
      Json members = Json::array();
      for (const ir::BundleMember& member : bundle.members) {
        const bool isBundle = member.bundle.has_value();
        members.push_back(
            {{"name", member.name},
             {"role", isBundle ? Json("bundle") : Json(nameOf(static_cast<p::Role>(member.role)))},
             {"type", isBundle ? Json() : Json(ir::print(module_, member.type))},
             {"rank", member.rank},
             {"bundle", isBundle ? Json(*member.bundle) : Json()}});
      }
      list.push_back({{"name", ir::qualifier(bundle.scope) + bundle.name + bundle.arguments},
                      {"members", std::move(members)}});
    }
    return list;
  }

  Json structs() const {
    Json list = Json::array();
    const TypeNames types(module_);
    for (const std::uint32_t index : usedStructs(module_)) {
      const ir::Type type = ir::Type::structType(index);
      Json members = Json::array();
      for (const ir::StructField& field : module_.structs[index].fields) {
        members.push_back({{"name", field.name}, {"type", ir::print(module_, field.type)}});
      }
      const ElementLayout layout = elementLayout(module_, types, type);
      Json planes = Json::array();
      for (const Plane& plane : layout.planes) planes.push_back(plane.member);
      list.push_back({{"name", ir::print(module_, type)},
                      {"size", layout.size},
                      {"members", std::move(members)},
                      {"planes", std::move(planes)}});
    }
    return list;
  }

  template <Described T>
  Json object(const T& descriptor) {
    Json members = Json::object();
    std::apply([&](const auto&... member) { (add(members, descriptor, member), ...); }, Members<T>::list);
    return members;
  }

  template <class T>
  void add(Json& members, const T& descriptor, const auto& member) {
    members[std::string(member.name)] = value(descriptor.*member.pointer);
  }
  template <class T, class M, class N>
  void add(Json& members, const T& descriptor, const CountedOption<T, M, N>& member) {
    members[std::string(member.name)] =
        value(std::span<const M>(descriptor.*member.first, descriptor.*member.number));
  }
  template <class T, class M>
  void add(Json&, const T&, const CppOption<T, M>&) {}
  template <class T, class M>
  void add(Json&, const T&, const OmittedMember<T, M>&) {}

  Json value(std::string_view text) { return text; }
  Json value(const p::Kernel& kernel) { return kernels_.indexOf(object(kernel)); }
  Json value(const p::Element& element) { return elements_.indexOf(object(element)); }
  template <class T>
    requires std::is_arithmetic_v<T>
  Json value(T number) {
    return number;
  }
  template <class E>
    requires std::is_enum_v<E>
  Json value(E enumerator) {
    return nameOf(enumerator);
  }
  /// JSON has no infinity, which is what no number stands for.
  Json value(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }
  template <class T>
  Json value(const std::optional<T>& descriptor) {
    return descriptor ? value(*descriptor) : Json(nullptr);
  }
  template <Described T>
  Json value(const T& descriptor) {
    return object(descriptor);
  }
  template <class T>
  Json value(const T* descriptor) {
    if (descriptor == nullptr) return nullptr;
    if constexpr (std::same_as<T, p::Table>)
      return indexOf(descriptor);
    else
      return value(*descriptor);
  }
  template <class T, std::size_t Count>
  Json value(const std::array<T, Count>& list) {
    return value(std::span<const T>(list));
  }
  template <class T>
  Json value(std::span<T> list) {
    Json items = Json::array();
    for (const auto& item : list) items.push_back(value(item));
    return items;
  }

  /// The index of a table among those that kernels use.
  Json indexOf(const p::Table* wanted) const {
    std::size_t index = 0;
    for (const p::Table* table : program_.tables()) {
      if (table == wanted) break;
      index += table != nullptr;
    }
    return index;
  }

  const ir::Module& module_;
  const Program& program_;
  Shared kernels_, elements_;
};

}  // namespace

std::string jsonText(const ir::Module& module, const Program& program, std::string_view fileName) {
  return Writer(module, program).write(fileName).dump(1) + "\n";
}

}  // namespace skc::emit
