// SPDX-License-Identifier: MIT
#include "obj.hpp"

#include <iterator>
#include <string>

#include <fmt/format.h>

#include "support/field_file.hpp"
#include "support/text_file.hpp"

namespace examples {
namespace {

/// Indices of OBJ count from 1; position, texture coordinate and normal of a corner have the same.
void addFace(std::string& text, std::int64_t a, std::int64_t b, std::int64_t c) {
  fmt::format_to(std::back_inserter(text), "f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", a + 1, b + 1, c + 1);
}

/// Calls `add` with the corners of each triangle that is not torn.
template <class Add>
void visitTriangles(int columns, int rows, std::span<const sk::float4> normals, const Add& add) {
  for (int y = 0; y + 1 < rows; ++y) {
    for (int x = 0; x + 1 < columns; ++x) {
      const int here = y * columns + x;
      const int whole = static_cast<int>(normals[static_cast<std::size_t>(here)].w);
      if (whole & 1) add(here, here + columns, here + 1);
      if (whole & 2) add(here + 1, here + columns, here + columns + 1);
    }
  }
}

SurfaceFile surfaceOf(int columns, int rows, std::span<const sk::float4> positions,
                      std::span<const sk::float4> normals) {
  SurfaceFile surface;
  FileField field{"Normals", 3, {}};
  for (const sk::float4& p : positions) surface.points.push_back({p.x, p.y, p.z});
  for (const sk::float4& n : normals) field.values.insert(field.values.end(), {n.x, n.y, n.z});
  surface.fields.push_back(std::move(field));
  visitTriangles(columns, rows, normals,
                 [&](int a, int b, int c) { surface.triangles.push_back({a, b, c}); });
  return surface;
}

std::string objOf(int columns, int rows, std::span<const sk::float4> positions,
                  std::span<const sk::float4> normals) {
  std::string text = fmt::format("# a cloth of {} x {} points\n", columns, rows);
  const auto out = std::back_inserter(text);
  for (const sk::float4& p : positions) fmt::format_to(out, "v {} {} {}\n", p.x, p.y, p.z);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      fmt::format_to(out, "vt {} {}\n", columns > 1 ? float(x) / float(columns - 1) : 0.0f,
                     rows > 1 ? 1.0f - float(y) / float(rows - 1) : 0.0f);
    }
  }
  for (const sk::float4& n : normals) fmt::format_to(out, "vn {} {} {}\n", n.x, n.y, n.z);
  visitTriangles(columns, rows, normals, [&](int a, int b, int c) { addFace(text, a, b, c); });
  return text;
}

}  // namespace

void saveMesh(const std::filesystem::path& file, int columns, int rows, std::span<const sk::float4> positions,
              std::span<const sk::float4> normals) {
  if (file.extension() == ".vtp") return saveSurface(file, surfaceOf(columns, rows, positions, normals));
  writeFile(file, objOf(columns, rows, positions, normals));
}

}  // namespace examples
