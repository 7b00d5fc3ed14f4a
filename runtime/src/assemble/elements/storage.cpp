// SPDX-License-Identifier: MIT
#include "assemble/elements/storage.hpp"

#include <algorithm>

#include "sk/scalar_bytes.hpp"

namespace sk::assemble {

using program::Element;
using program::Field;
using program::Kernel;
using program::Parameter;
using program::Scalar;

namespace {

/// Adds the planes of a float field: one of halves, or several of doubles, with two doubles per texel.
void addFields(const Field& field, Storage storage, std::vector<Field>& fields) {
  const bool isRow = field.part >= 0;  // of a matrix
  if (field.scalar != Scalar::Float || isRow) {
    fields.push_back(field);
    return;
  }
  Field held = field;
  held.scalar = storage == Storage::Half ? Scalar::Half : Scalar::Double;
  if (storage == Storage::Half || field.width <= 2) {
    fields.push_back(held);
    return;
  }
  for (int part = 0; 2 * part < field.width; ++part) {
    held.part = static_cast<std::int8_t>(part);
    held.width = static_cast<std::uint8_t>(std::min(2, field.width - 2 * part));
    fields.push_back(held);
  }
}

}  // namespace

HeldElement::HeldElement(const Element& declared, Storage storage) : element(declared) {
  for (const Field& field : declared.fields) addFields(field, storage, fields);
  std::uint32_t end = 0;
  for (Field& field : fields) {
    field.offset = end;
    end += static_cast<std::uint32_t>(program::hostBytes(field.scalar)) * field.width;
  }
  element.fields = fields;
  element.size = end;
}

bool holdsFloats(const Element& element) {
  return std::ranges::any_of(
      element.fields, [](const Field& field) { return field.scalar == Scalar::Float && field.part < 0; });
}

HeldKernel::HeldKernel(const Kernel& kernel, std::span<const StreamAccess> access)
    : kernel_(kernel), parameters_(kernel.parameters.begin(), kernel.parameters.end()) {
  for (std::size_t i = 0; i < access.size(); ++i) {
    if (access[i].storage == Storage::Single) continue;
    const Element& plain = heldBy(parameters_[i]);
    parameters_[i].held =
        &elements_.emplace_back(std::make_unique<HeldElement>(plain, access[i].storage))->element;
    kernel_.usesDoubles = kernel_.usesDoubles || access[i].storage != Storage::Half;
  }
  if (!elements_.empty()) kernel_.parameters = parameters_;
}

}  // namespace sk::assemble
