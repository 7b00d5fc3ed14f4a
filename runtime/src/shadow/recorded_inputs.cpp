// SPDX-License-Identifier: MIT
#include "shadow/recorded_inputs.hpp"

#include <algorithm>
#include <cstring>
#include <exception>

#include <fmt/format.h>

#include "sk/scalar_bytes.hpp"
#include "support/npz.hpp"

namespace sk::shadow {

void RecordedInputs::add(std::string_view parameter, const program::Element& element, const Shape& shape,
                         const std::byte* elements) {
  const std::int64_t count = shape.rank() == 0 ? 1 : shape.size();
  for (std::size_t begin = 0; begin < element.fields.size();) {
    // the rows of a matrix have one path
    std::vector<program::Field> member;
    const std::string_view path = element.fields[begin].path;
    for (; begin < element.fields.size() && element.fields[begin].path == path; ++begin) {
      member.push_back(element.fields[begin]);
      member.back().path = {};
    }
    const program::Element item{.name = {}, .glsl = {}, .size = 0, .fields = member};
    Array array{path.empty() ? std::string(parameter) : fmt::format("{}.{}", parameter, path),
                npy::npyArray(item, shape, /*asDoubles=*/false),
                {}};
    for (std::int64_t i = 0; i < count; ++i) {
      for (const program::Field& field : member) {
        const std::byte* const from = elements + static_cast<std::size_t>(i) * element.size + field.offset;
        array.elements.insert(array.elements.end(), from,
                              from + field.width * program::hostBytes(field.scalar));
      }
    }
    arrays_.push_back(std::move(array));
  }
}

void RecordedInputs::addShape(std::string_view parameter, const Shape& shape) {
  Array array{fmt::format("{}.shape", parameter), {"'<i8'", {shape.rank()}}, {}};
  for (int d = 0; d < shape.rank(); ++d) {
    const std::int64_t extent = shape[d];
    const auto* const bytes = reinterpret_cast<const std::byte*>(&extent);
    array.elements.insert(array.elements.end(), bytes, bytes + sizeof extent);
  }
  arrays_.push_back(std::move(array));
}

bool isRecordable(const program::Element& element) {
  return std::ranges::none_of(element.fields, [](const program::Field& field) {
    return field.path.find('[') != std::string_view::npos;
  });
}

std::string writeInputs(const std::string& file, const std::map<std::string, RecordedInputs>& kernels) {
  try {
    npy::NpzWriter writer(file);
    for (const auto& [kernel, inputs] : kernels) {
      for (const RecordedInputs::Array& each : inputs.arrays())
        writer.add(fmt::format("{}/{}", kernel, each.name), each.array, each.elements);
    }
    writer.finish();
    return {};
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace sk::shadow
