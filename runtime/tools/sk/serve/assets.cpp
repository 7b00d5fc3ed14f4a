// SPDX-License-Identifier: MIT
#include "serve/assets.hpp"

#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

namespace sk_tool {
namespace {

namespace fs = std::filesystem;

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(fmt::format("'{}' cannot be read", file.string()));
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string typeOf(const fs::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".js") return "text/javascript; charset=utf-8";
  if (extension == ".css") return "text/css; charset=utf-8";
  if (extension == ".svg") return "image/svg+xml";
  if (extension == ".html") return "text/html; charset=utf-8";
  return {};
}

/// Adds the files of a folder, but for those of its folders. Returns whether there are any.
bool addFolder(const fs::path& folder, const std::string& path, std::map<std::string, Asset>& files) {
  if (!fs::is_directory(folder)) return false;
  bool any = false;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string type = typeOf(entry.path());
    if (!entry.is_regular_file() || type.empty()) continue;
    files[path + entry.path().filename().string()] = {textOf(entry.path()), type};
    any = true;
  }
  return any;
}

}  // namespace

Assets readAssets(const fs::path& folder) {
  Assets assets;
  if (!addFolder(folder / "playground", "/", assets.files)) {
    throw std::runtime_error(
        fmt::format("the page's files are not in '{}'; install StreamKernel, or build it anew",
                    (folder / "playground").string()));
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "playground" / "programs")) {
    assets.programs[entry.path().filename().string()] = textOf(entry.path());
  }
  assets.hasPackage = addFolder(folder / "package" / "dist", "/streamkernel/", assets.files);
  assets.hasEditor = addFolder(folder / "editor", "/editor/", assets.files);
  return assets;
}

}  // namespace sk_tool
