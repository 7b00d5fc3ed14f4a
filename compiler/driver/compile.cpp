// SPDX-License-Identifier: MIT
#include "driver/compile.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <fmt/format.h>

#include "assemble/assemble.hpp"
#include "driver/glsl_listing.hpp"
#include "driver/plan_listing.hpp"
#include "emit/program.hpp"
#include "emit/stub.hpp"
#include "frontend/frontend.hpp"
#include "ir/print.hpp"
#include "transforms/check_outputs.hpp"
#include "transforms/transforms.hpp"

namespace skc::driver {
namespace {

namespace fs = std::filesystem;

frontend::Options frontendOptions(const Options& options) {
  return {options.includeDirectories, options.definitions, options.warnings, options.color};
}

TransformOptions transformOptions(const Options& options) {
  TransformOptions result;
  for (const sk::assemble::Profile& profile : sk::assemble::profiles()) {
    result.limits.push_back(
        {static_cast<std::uint32_t>(profile.drawBuffers), static_cast<std::uint32_t>(profile.textureUnits)});
  }
  if (!options.printAfter.empty()) {
    result.after = [wanted = options.printAfter](std::string_view name, const ir::Module& module) {
      if (wanted == "all" || wanted == name)
        std::cout << "// after " << name << "\n" << ir::print(module) << "\n";
    };
  }
  return result;
}

std::string qualifiedName(const ir::Kernel& kernel) { return ir::qualifier(kernel.scope) + kernel.name; }

/// Keeps the kernels that --kernel names, with or without their namespaces.
bool selectKernel(ir::Module& module, const std::string& wanted) {
  std::string known;
  for (const ir::Kernel& kernel : module.kernels)
    known += (known.empty() ? "" : ", ") + qualifiedName(kernel);
  std::erase_if(module.kernels, [&](const ir::Kernel& kernel) {
    return kernel.name != wanted && qualifiedName(kernel) != wanted;
  });
  if (!module.kernels.empty()) return true;
  fmt::print(stderr, "skc: '{}' has no kernel '{}'; it has {}\n", module.file, wanted, known);
  return false;
}

bool writeFile(const fs::path& path, const std::string& text) {
  errno = 0;
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (out) return true;
  fmt::print(stderr, "skc: '{}' cannot be written: {}\n", path.string(), std::strerror(errno ? errno : EIO));
  return false;
}

/// Spaces and '$' as make wants them.
std::string makeEscaped(const std::string& path) {
  std::string text;
  for (const char c : path) {
    if (c == ' ' || c == '#') text += '\\';
    if (c == '$') text += '$';
    text += c;
  }
  return text;
}

bool writeStubs(const Options& options, const ir::Module& module, const frontend::Frontend& frontend) {
  const emit::Program program(module);
  const std::string name = fs::path(module.file).filename().string();
  const emit::Stub stub = emit::emitStub(module, program, name);
  std::error_code error;
  fs::create_directories(options.outputDirectory, error);   // a failure shows when the files are written
  const fs::path base = fs::path(options.outputDirectory) / name;
  const std::string header = base.string() + ".hpp";
  const std::string source = base.string() + ".cpp";
  if (!writeFile(header, stub.header) || !writeFile(source, stub.source)) return false;
  if (options.depfile.empty()) return true;
  std::string rule = makeEscaped(header) + " " + makeEscaped(source) + ":";
  for (const std::string& file : frontend.dependencies()) rule += " \\\n  " + makeEscaped(file);
  return writeFile(options.depfile, rule + "\n");
}

}  // namespace

int compile(const Options& options, const std::string& file) {
  frontend::Frontend frontend(frontendOptions(options));
  std::optional<ir::Module> module = frontend.compile(file);
  if (options.emit == Emit::Ast) {
    frontend.dumpAst(std::cout);
    return module ? 0 : 1;
  }
  if (!module) return 1;
  if (!options.kernel.empty() && !selectKernel(*module, options.kernel)) return 1;
  checkOutputs(*module, frontend.diagnostics());   // on what the user wrote, before anything is rewritten
  if (!frontend.diagnostics().hasErrors()) {
    runTransforms(*module, frontend.diagnostics(), transformOptions(options));
  }
  if (frontend.diagnostics().hasErrors()) return 1;
  switch (options.emit) {
    case Emit::Ir: std::cout << ir::print(*module); break;
    case Emit::Glsl: std::cout << glslListing(emit::Program(*module), options.profile); break;
    case Emit::Plan: std::cout << planListing(*module, options.profile); break;
    case Emit::Stubs: return writeStubs(options, *module, frontend) ? 0 : 1;
    case Emit::Ast: break;   // printed above
  }
  std::cout.flush();
  return std::cout ? 0 : 1;
}

}  // namespace skc::driver
