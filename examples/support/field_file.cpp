// SPDX-License-Identifier: MIT
#include "support/field_file.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <sk/npy.hpp>

#include "support/image.hpp"
#include "support/text_file.hpp"

namespace examples {
namespace {

namespace fs = std::filesystem;

template <class T>
void append(std::string& bytes, T number) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof number);
}
static_assert(std::endian::native == std::endian::little, "files have little-endian numbers");

/// The arrays of a VTK file, which follow its text one after the other.
class VtkData {
 public:
  /// The element of XML for an array of these numbers.
  template <class T, class Numbers>
  std::string array(std::string_view type, std::string_view name, int components, const Numbers& numbers) {
    std::string element = fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        type, name, components, bytes_.size());
    append(bytes_, static_cast<std::uint64_t>(numbers.size() * sizeof(T)));
    for (const auto number : numbers) append(bytes_, static_cast<T>(number));
    return element;
  }

  std::string fields(const std::vector<FileField>& all) {
    std::string elements;
    for (const FileField& field : all)
      elements += array<float>("Float32", field.name, field.components, field.values);
    return elements;
  }

  /// The whole file around what describes its one piece.
  std::string file(std::string_view type, std::string_view inner) const {
    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n{}"
        "<AppendedData encoding=\"raw\">\n_",
        type, inner);
    text += bytes_;
    return text + "\n</AppendedData>\n</VTKFile>\n";
  }

 private:
  std::string bytes_;
};

std::string imageData(const GridFile& grid) {
  VtkData data;
  const auto& [width, height, depth] = grid.cells;
  // A plane has one layer of points, so that its cells are squares.
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", width, height, depth > 1 ? depth : 0);
  const std::string cells = data.fields(grid.fields);
  return data.file(
      "ImageData",
      fmt::format("<ImageData WholeExtent=\"{0}\" Origin=\"0 0 0\" Spacing=\"{1:.9g} {1:.9g} {1:.9g}\">\n"
                  "<Piece Extent=\"{0}\">\n<CellData>\n{2}</CellData>\n</Piece>\n</ImageData>\n",
                  extent, grid.spacing, cells));
}

std::string polyData(const SurfaceFile& surface) {
  VtkData data;
  std::vector<double> points;
  for (const Vector& p : surface.points) points.insert(points.end(), {p.x, p.y, p.z});
  std::vector<std::int32_t> corners, ends;
  for (const auto& triangle : surface.triangles) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
    ends.push_back(static_cast<std::int32_t>(corners.size()));
  }
  const std::string fields = data.fields(surface.fields);
  const std::string places = data.array<float>("Float32", "Points", 3, points);
  const std::string connectivity = data.array<std::int32_t>("Int32", "connectivity", 1, corners);
  const std::string offsets = data.array<std::int32_t>("Int32", "offsets", 1, ends);
  return data.file(
      "PolyData",
      fmt::format(
          "<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\">\n<PointData>\n{}</PointData>\n"
          "<Points>\n{}</Points>\n<Polys>\n{}{}</Polys>\n</Piece>\n</PolyData>\n",
          surface.points.size(), surface.triangles.size(), fields, places, connectivity, offsets));
}

std::vector<std::int64_t> extentsOf(const GridFile& grid, const FileField& field) {
  const auto& [width, height, depth] = grid.cells;
  std::vector<std::int64_t> extents = {height, width};
  if (depth > 1) extents.insert(extents.begin(), depth);
  if (field.components > 1) extents.push_back(field.components);
  return extents;
}

std::vector<double> fromPicture(const fs::path& file, std::int64_t width, std::int64_t height) {
  const Picture picture = loadPicture(file);
  if (picture.width != width || picture.height != height) {
    throw std::runtime_error(fmt::format("the picture '{}' has {} x {} pixels, and the grid {} x {} cells",
                                         file.string(), picture.width, picture.height, width, height));
  }
  std::vector<double> values;
  values.reserve(picture.pixels.size());
  for (std::int64_t y = height - 1; y >= 0; --y) {
    for (std::int64_t x = 0; x < width; ++x) {
      const sk::int3& p = picture.pixels[static_cast<std::size_t>(y * width + x)];
      values.push_back((0.2126 * p.x + 0.7152 * p.y + 0.0722 * p.z) / picture.white);
    }
  }
  return values;
}

}  // namespace

void checkGridName(const fs::path& file) {
  const std::string ending = file.extension().string();
  if (ending != ".vti" && ending != ".npy" && ending != ".raw") {
    throw std::runtime_error(
        fmt::format("fields cannot be written to '{}': the name must end in .vti (VTK), .npy (NumPy) or .raw "
                    "(floats alone)",
                    file.string()));
  }
}

std::vector<fs::path> saveGrid(const fs::path& file, const GridFile& grid) {
  checkGridName(file);
  if (file.extension() == ".vti") {
    writeFile(file, imageData(grid));
    return {file};
  }
  std::error_code ignored;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), ignored);
  std::vector<fs::path> files;
  for (const FileField& field : grid.fields) {
    fs::path name = file;
    name.replace_filename(
        fmt::format("{}_{}{}", file.stem().string(), field.name, file.extension().string()));
    if (file.extension() == ".npy") {
      sk::writeNpy(name, extentsOf(grid, field), field.values);
    } else {
      std::string bytes;
      for (const double value : field.values) append(bytes, static_cast<float>(value));
      writeFile(name, bytes);
    }
    files.push_back(name);
  }
  return files;
}

void saveSurface(const fs::path& file, const SurfaceFile& surface) {
  if (file.extension() != ".vtp")
    throw std::runtime_error(
        fmt::format("a surface cannot be written to '{}': the name must end in .vtp (VTK)", file.string()));
  writeFile(file, polyData(surface));
}

std::vector<double> loadGrid(const fs::path& file, const std::array<std::int64_t, 3>& cells) {
  const auto& [width, height, depth] = cells;
  if (file.extension() != ".npy") {
    if (depth > 1)
      throw std::runtime_error(
          fmt::format("'{}': a grid in space is read from a .npy file of the shape (depth, height, width)",
                      file.string()));
    return fromPicture(file, width, height);
  }
  sk::NumberArray array = sk::readNpy(file);
  std::vector<std::int64_t> wanted = {height, width};
  if (depth > 1) wanted.insert(wanted.begin(), depth);
  if (array.extents != wanted) {
    throw std::runtime_error(fmt::format("'{}' has an array of the shape ({}), and the grid needs ({})",
                                         file.string(), fmt::join(array.extents, ", "),
                                         fmt::join(wanted, ", ")));
  }
  for (std::size_t i = 0; i < array.values.size(); ++i) {
    if (!std::isfinite(array.values[i]))
      throw std::runtime_error(fmt::format("'{}': number {} is not finite", file.string(), i));
  }
  return std::move(array.values);
}

std::vector<double> readField(const SceneTable& table, const std::string& key, const fs::path& folder,
                              const std::array<std::int64_t, 3>& cells) {
  const std::string rangeKey = key + "_range";
  const std::optional<std::string> file = table.text(key);
  const std::optional<std::vector<double>> range = table.numbers(rangeKey, 2);
  if (!file) {
    if (range) table.refuse(rangeKey, fmt::format("belongs to {}, which is missing", key));
    return {};
  }
  std::vector<double> values;
  try {
    values = loadGrid(folder / *file, cells);
  } catch (const std::exception& error) {
    table.refuse(key, fmt::format("cannot be used: {}", error.what()));
  }
  if (range) {
    for (double& value : values) value = (*range)[0] + ((*range)[1] - (*range)[0]) * value;
  }
  return values;
}

}  // namespace examples
