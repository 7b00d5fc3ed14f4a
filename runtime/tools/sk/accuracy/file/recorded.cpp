// SPDX-License-Identifier: MIT
#include "accuracy/file/recorded.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "assemble/nearest_word.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk_tool {

namespace {

using sk::npy::NpyArray;
using sk::npy::NpzArray;
using sk::program::Element;
using sk::program::Parameter;
using sk::program::Role;

using Plane = sk::program::Field;
using Extents = std::vector<std::int64_t>;
using Arrays = std::map<std::string, NpzArray, std::less<>>;

/// "; did you mean 'u'?", or nothing.
std::string didYouMean(std::string_view word, const std::set<std::string>& known) {
  const std::vector<std::string> words(known.begin(), known.end());
  const std::string_view nearest = sk::assemble::nearestWord(word, words);
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

/// A part of an element that has an array of its own: the whole element, or a member of a struct.
struct RecordedMember {
  std::string suffix;  ///< ".body.mass", or empty
  std::vector<const Plane*> fields;
  Extents components;  ///< behind the shape
  std::string type;  ///< as NumPy spells it
};

/// "a.b" of "a.b[2]": arrays have one array for all items.
std::string_view withoutItem(std::string_view path) { return path.substr(0, path.find('[')); }

RecordedMember memberOf(std::string_view path, const std::vector<const Plane*>& fields,
                        std::string_view parameter) {
  RecordedMember member{
      .suffix = path.empty() ? "" : fmt::format(".{}", path), .fields = fields, .components = {}, .type = {}};
  std::set<std::string_view> items;
  for (const Plane* field : fields) {
    if (!field->path.ends_with(']') && field->path != path)
      throw std::runtime_error(
          fmt::format("'{}' is an array of structs, which --inputs does not read", parameter));
    items.insert(field->path);
  }
  if (fields.front()->path != path) member.components.push_back(static_cast<std::int64_t>(items.size()));
  std::vector<Plane> item;  // one, as an element of its own
  for (const Plane* field : fields) {
    if (field->path != fields.front()->path) continue;
    item.push_back(*field);
    item.back().path = {};
  }
  const Element element{.name = {}, .glsl = {}, .size = 0, .fields = item};
  const NpyArray array = sk::npy::npyArray(element, {}, /*asDoubles=*/false);
  member.components.insert(member.components.end(), array.extents.begin(), array.extents.end());
  member.type = array.type;
  return member;
}

std::vector<RecordedMember> membersOf(const Parameter& parameter) {
  std::vector<RecordedMember> members;
  const auto& fields = parameter.element->fields;
  for (std::size_t begin = 0; begin < fields.size();) {
    const std::string_view path = withoutItem(fields[begin].path);
    std::vector<const Plane*> own;
    for (; begin < fields.size() && withoutItem(fields[begin].path) == path; ++begin)
      own.push_back(&fields[begin]);
    members.push_back(memberOf(path, own, parameter.name));
  }
  return members;
}

sk::Shape shapeWith(const Extents& extents) { return extents.empty() ? sk::Shape() : shapeOf(extents); }

/// The arrays of one kernel, as its parameters want them.
class RecordedCallInputs {
 public:
  RecordedCallInputs(const std::string& file, const Arrays& arrays, const Subject& subject,
                     const std::set<std::string>& given)
      : file_(file), arrays_(arrays), subject_(subject), given_(given) {}

  Inputs read() {
    refuseUnknown();
    Inputs inputs;
    for (const Parameter& parameter : subject_.parameters()) inputs.parameters.push_back(inputOf(parameter));
    inputs.extent.domain = domainOf(inputs);
    inputs.extent.results = resultsOf(inputs);
    for (std::size_t p = 0; p < inputs.parameters.size(); ++p) {
      if (isResult(subject_.parameters()[p])) inputs.parameters[p].shape = inputs.extent.results;
    }
    inputs.elements = identifyingElements(inputs.extent);
    return inputs;
  }

 private:
  [[noreturn]] void fail(std::string_view array, std::string_view what) const {
    throw std::runtime_error(fmt::format("'{}': '{}/{}' {}", file_, subject_.name(), array, what));
  }

  std::set<std::string> expected() const {
    std::set<std::string> names;
    for (const Parameter& parameter : subject_.parameters()) {
      const std::string name(parameter.name);
      if (isResult(parameter)) {
        names.insert(name + ".shape");
        continue;
      }
      for (const RecordedMember& member : membersOf(parameter)) names.insert(name + member.suffix);
    }
    return names;
  }

  void refuseUnknown() const {
    const std::set<std::string> names = expected();
    for (const std::string& name : given_) {
      if (!names.contains(name)) fail(name, fmt::format("is of no parameter{}", didYouMean(name, names)));
    }
  }

  const NpzArray& array(const std::string& name) const {
    if (given_.contains(name)) return arrays_.find(subject_.name() + "/" + name)->second;
    std::set<std::string> others = given_;
    fail(name, fmt::format("is missing{}", didYouMean(name, others)));
  }

  /// True for a stream that the values of spec parameters may switch off, and that is not there.
  bool isAbsent(const Parameter& parameter) const {
    if (parameter.neededIf.steps.empty() || (parameter.role != Role::Input && parameter.role != Role::Gather))
      return false;
    return std::ranges::none_of(membersOf(parameter), [&](const RecordedMember& member) {
      return given_.contains(std::string(parameter.name) + member.suffix);
    });
  }

  ParameterInput inputOf(const Parameter& parameter) const {
    if (isResult(parameter)) return {};
    if (isAbsent(parameter)) return {.shape = {}, .bytes = {}, .isAbsent = true};
    std::optional<Extents> shape;
    ParameterInput input;
    for (const RecordedMember& member : membersOf(parameter)) {
      const std::string name = std::string(parameter.name) + member.suffix;
      const NpzArray& recorded = array(name);
      Extents extents = shapeIn(parameter, member, name, recorded.array);
      if (shape && *shape != extents)
        fail(name, fmt::format("is for streams of another shape than the members before it, {}",
                               sk::npy::npyShape(*shape)));
      shape = std::move(extents);
      copyTo(input, parameter, member, recorded);
    }
    if (!isValue(parameter)) input.shape = shapeWith(*shape);
    return input;
  }

  /// The shape in front of the components, after checking both and the type.
  Extents shapeIn(const Parameter& parameter, const RecordedMember& member, const std::string& name,
                  const NpyArray& recorded) const {
    if (recorded.type != member.type)
      fail(name, fmt::format("has elements of type {}, but '{} {}' needs {}", recorded.type,
                             parameter.element->name, parameter.name, member.type));
    const std::size_t behind = member.components.size();
    const bool fits = recorded.extents.size() >= behind &&
                      std::equal(member.components.begin(), member.components.end(),
                                 recorded.extents.end() - static_cast<std::ptrdiff_t>(behind));
    Extents shape;
    if (fits)
      shape.assign(recorded.extents.begin(), recorded.extents.end() - static_cast<std::ptrdiff_t>(behind));
    if (!fits || !isRankRight(parameter, shape))
      fail(name, fmt::format("has shape {}, but '{} {}' needs {}", sk::npy::npyShape(recorded.extents),
                             parameter.element->name, parameter.name, wanted(parameter, member)));
    return shape;
  }

  static bool isRankRight(const Parameter& parameter, const Extents& shape) {
    if (parameter.role == Role::Iterator) return shape == Extents{2};
    if (isValue(parameter)) return shape.empty();
    return parameter.role == Role::Gather ? shape.size() == parameter.rank
                                          : !shape.empty() && shape.size() <= 4;
  }

  /// What the shape of a parameter's array should be, in words.
  static std::string wanted(const Parameter& parameter, const RecordedMember& member) {
    const bool hasComponents = !member.components.empty();
    if (parameter.role == Role::Iterator || isValue(parameter)) {
      Extents extents = member.components;
      if (parameter.role == Role::Iterator) extents.insert(extents.begin(), 2);
      return sk::npy::npyShape(extents);
    }
    const std::string rank = parameter.role == Role::Gather ? fmt::format("{}", parameter.rank) : "1 to 4";
    return fmt::format(
        "{} dimension(s){}", rank,
        hasComponents ? fmt::format(", and then {}", sk::npy::npyShape(member.components)) : "");
  }

  static void copyTo(ParameterInput& input, const Parameter& parameter, const RecordedMember& member,
                     const NpzArray& recorded) {
    const std::size_t bytes = sk::program::hostBytes(member.fields.front()->scalar);
    std::size_t width = 0;
    for (const Plane* field : member.fields) width += field->width * bytes;
    const std::size_t count = recorded.elements.size() / width, size = parameter.element->size;
    input.bytes.resize(count * size);
    const std::byte* from = recorded.elements.data();
    for (std::size_t i = 0; i < count; ++i) {
      for (const Plane* field : member.fields) {
        std::memcpy(input.bytes.data() + i * size + field->offset, from, field->width * bytes);
        from += field->width * bytes;
      }
    }
  }

  /// The shape of an output; nullopt if it is not recorded.
  std::optional<sk::Shape> shapeOfResult(const Parameter& parameter) const {
    const std::string name = std::string(parameter.name) + ".shape";
    if (parameter.role == Role::Accumulator && !given_.contains(name)) return std::nullopt;
    const NpzArray& recorded = array(name);
    Extents extents(recorded.elements.size() / sizeof(std::int64_t));
    if (recorded.array.type != "'<i8'" || recorded.array.extents.size() != 1 || extents.empty() ||
        extents.size() > 4)
      fail(name, "is no shape: 1 to 4 extents of type '<i8'");
    std::memcpy(extents.data(), recorded.elements.data(), recorded.elements.size());
    if (std::ranges::any_of(extents, [](std::int64_t extent) { return extent < 1; }))
      fail(name, "has no elements");
    return shapeWith(extents);
  }

  /// The common shape of outputs, or of accumulators; nullopt if there are none.
  std::optional<sk::Shape> commonResults() const {
    std::optional<sk::Shape> common;
    for (const Parameter& parameter : subject_.parameters()) {
      if (!isResult(parameter)) continue;
      const std::optional<sk::Shape> shape = shapeOfResult(parameter);
      if (common && shape && *common != *shape)
        fail(std::string(parameter.name) + ".shape", "is another shape than that of the result before it");
      if (shape) common = shape;
    }
    return common;
  }

  sk::Shape domainOf(const Inputs& inputs) const {
    if (!subject_.isReduce()) return *commonResults();
    sk::Shape domain;
    for (std::size_t p = 0; p < inputs.parameters.size(); ++p) {
      const Parameter& parameter = subject_.parameters()[p];
      const sk::Shape& shape = inputs.parameters[p].shape;
      if (parameter.role != Role::Input || inputs.parameters[p].isAbsent) continue;
      if (domain.rank() == 0) domain = shape;
      if (domain.rank() != shape.rank())
        fail(parameter.name, "has another number of dimensions than the input before it");
      for (int d = 0; d < shape.rank(); ++d) domain = domain.with(d, std::max(domain[d], shape[d]));
    }
    if (domain.rank() == 0)
      throw std::runtime_error(
          fmt::format("'{}': {} has no element inputs, so that its domain is not known; leave out its arrays",
                      file_, subject_.name()));
    return domain;
  }

  sk::Shape resultsOf(const Inputs& inputs) const {
    const sk::Shape& domain = inputs.extent.domain;
    if (!subject_.isReduce()) return domain;
    const sk::Shape results = commonResults().value_or(cubeOf(domain.rank(), 1));
    if (domain.size() % results.size() != 0)
      throw std::runtime_error(
          fmt::format("'{}': {} has inputs of shape {}, which its results of shape {} do not divide", file_,
                      subject_.name(), sk::toString(domain), sk::toString(results)));
    return results;
  }

  const std::string& file_;
  const Arrays& arrays_;
  const Subject& subject_;
  const std::set<std::string>& given_;
};

}  // namespace

RecordedInputs::RecordedInputs(const std::filesystem::path& file)
    : file_(file.string()), arrays_(sk::npy::readNpz(file)) {
  for (const auto& [name, array] : arrays_) {
    const std::size_t slash = name.find('/');
    if (slash == std::string::npos)
      throw std::runtime_error(
          fmt::format("'{}': '{}' is not named KERNEL/PARAMETER, such as 'heat::diffuse/u'", file_, name));
    parametersOf_[name.substr(0, slash)].insert(name.substr(slash + 1));
  }
}

std::string RecordedInputs::lackOf(const std::string& kernel) const {
  std::set<std::string> known;
  for (const auto& [name, ignored] : parametersOf_) known.insert(name);
  return fmt::format("'{}' has no inputs of '{}'{}", file_, kernel, didYouMean(kernel, known));
}

void RecordedInputs::check(std::span<const Subject> subjects) const {
  const auto isRecorded = [&](const Subject& subject) { return has(subject.name()); };
  if (!std::ranges::any_of(subjects, isRecorded)) throw std::runtime_error(lackOf(subjects.front().name()));
}

Inputs RecordedInputs::of(const Subject& subject) const {
  return RecordedCallInputs(file_, arrays_, subject, parametersOf_.find(subject.name())->second).read();
}

}  // namespace sk_tool
