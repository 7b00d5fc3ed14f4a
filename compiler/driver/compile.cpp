// SPDX-License-Identifier: MIT
#include "driver/compile.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "assemble/assemble.hpp"
#include "bounds/bounds.hpp"
#include "driver/listings.hpp"
#include "driver/native_library.hpp"
#include "driver/performance_warnings.hpp"
#include "frontend/frontend.hpp"
#include "ir/build.hpp"
#include "ir/print.hpp"
#include "ir/walk.hpp"
#include "program/cpp_names.hpp"
#include "program/descriptors.hpp"
#include "program/json.hpp"
#include "program/stub.hpp"
#include "support/internal_error.hpp"
#include "transforms/check_limits.hpp"
#include "transforms/check_outputs.hpp"
#include "transforms/predicate.hpp"
#include "transforms/transforms.hpp"
#include "web/js_module.hpp"
#include "web/js_names.hpp"

namespace skc::driver {
namespace {

namespace fs = std::filesystem;

/// The input of a compilation, and the streams for its output and messages.
struct Job {
  const Options& options;
  std::string file;
  const std::string* text = nullptr;   ///< the file's text, if it is in memory
  std::ostream& output = std::cout;
  std::ostream& messages = std::cerr;
};

frontend::Options frontendOptions(const Job& job) {
  const Options& options = job.options;
  return {.includeDirectories = options.includeDirectories,
          .definitions = options.definitions,
          .warnings = options.warnings,
          .color = options.color,
          .fixIts = options.fixIts,
          .messages = job.text == nullptr ? nullptr : &job.messages,
          .isIsolated = options.isolated};
}

TransformOptions transformOptions(const Options& options, std::ostream& output) {
  TransformOptions result;
  for (const sk::assemble::Profile& profile : sk::assemble::profiles()) {
    result.limits.push_back(
        {static_cast<std::uint32_t>(profile.drawBuffers), static_cast<std::uint32_t>(profile.textureUnits)});
  }
  result.expandsSelects = sk::assemble::findProfile(options.profile)->webgl;
  for (const MeasuredDevice& device : options.devices) result.limits.push_back(device.limits);
  const bool isWhole = options.emit == Emit::Stubs || options.emit == Emit::Js || options.emit == Emit::Json;
  // Bounds follow from the kernels as declared, in every precision; the variants say which precisions there are.
  const bool isBounds = options.emit == Emit::Bounds;
  result.precisions = options.precision.empty() ? isWhole || isBounds : options.precision != "single";
  if (!options.printAfter.empty()) {
    result.after = [&output, wanted = options.printAfter](std::string_view name, const ir::Module& module) {
      if (wanted == "all" || wanted == name)
        output << "// after " << name << "\n" << ir::print(module) << "\n";
    };
  }
  return result;
}

/// Whether a module for browsers needs kernels in other precisions: one declares or lists them.
bool wantsPrecisions(const ir::Module& module) {
  return std::ranges::any_of(module.kernels, [](const ir::Kernel& kernel) {
    const ir::Choices& choices = kernel.choices;
    const auto isDeclared = [&](sk::Precision precision) {
      return choices.precision == static_cast<std::uint8_t>(precision);
    };
    return ir::isAhead(choices, ir::Ahead::Half) || ir::isAhead(choices, ir::Ahead::Extended) ||
           isDeclared(sk::Precision::Half) || isDeclared(sk::Precision::Extended) ||
           isDeclared(sk::Precision::Double);
  });
}

std::string qualifiedName(const ir::Kernel& kernel) { return ir::qualifier(kernel.scope) + kernel.name; }

/// Keeps only the kernels that --kernel names, with or without their namespaces.
bool selectKernel(ir::Module& module, const std::string& wanted, std::ostream& messages) {
  std::vector<std::string> names;
  const auto addName = [&](const ir::Kernel& kernel) {
    if (std::ranges::find(names, qualifiedName(kernel)) == names.end())
      names.push_back(qualifiedName(kernel));
  };
  for (const ir::Kernel& kernel : module.kernels) {
    if (!kernel.isOfPipeline) addName(kernel);
  }
  for (const ir::Pipeline& pipeline : module.pipelines) addName(pipeline.face);
  const std::string known = fmt::format("{}", fmt::join(names, ", "));
  const auto isNamed = [&](const ir::Kernel& kernel) {
    return kernel.name == wanted || qualifiedName(kernel) == wanted;
  };
  std::set<const ir::Kernel*> wantedKernels;
  for (const ir::Kernel& kernel : module.kernels) {
    if (isNamed(kernel)) wantedKernels.insert(&kernel);
  }
  std::erase_if(module.pipelines, [&](const ir::Pipeline& pipeline) { return !isNamed(pipeline.face); });
  for (const ir::Pipeline& pipeline : module.pipelines) {
    for (const ir::PipelinePass& pass : pipeline.passes) {
      const ir::Kernel& kernel = module.kernels[pass.kernel];
      wantedKernels.insert(&kernel);
      if (kernel.reduction && kernel.reduction->combine)
        wantedKernels.insert(&module.kernels[*kernel.reduction->combine]);
      if (kernel.assertions) wantedKernels.insert(&module.kernels[kernel.assertions->check]);
    }
  }
  const auto isWanted = [&](const ir::Kernel& kernel) { return wantedKernels.contains(&kernel); };
  std::vector<ir::KernelId> numbers;  // old ids of the kept kernels; combining overloads share the name
  ir::KernelId next = 0;
  for (const ir::Kernel& kernel : module.kernels) numbers.push_back(isWanted(kernel) ? next++ : next);
  std::vector<ir::Kernel> kept;
  for (ir::Kernel& kernel : module.kernels) {
    if (isWanted(kernel)) kept.push_back(std::move(kernel));
  }
  module.kernels = std::move(kept);
  for (ir::Pipeline& pipeline : module.pipelines) {
    for (ir::PipelinePass& pass : pipeline.passes) pass.kernel = numbers[pass.kernel];
  }
  for (ir::Kernel& kernel : module.kernels) {
    if (kernel.reduction && kernel.reduction->combine) {
      kernel.reduction->combine = numbers[*kernel.reduction->combine];
    }
    if (kernel.assertions) kernel.assertions->check = numbers[kernel.assertions->check];
  }
  if (!module.kernels.empty()) return true;
  messages << fmt::format("skc: '{}' has no kernel '{}'; it has {}\n", module.file, wanted,
                          known.empty() ? "none" : known);
  return false;
}

/// Whether each range of --range is one of a parameter.
bool checkRanges(const ir::Module& module, const std::vector<bounds::NamedRange>& ranges,
                 std::ostream& messages) {
  const auto parameterOf = [](const std::string& name) { return name.substr(0, name.find_first_of(".[")); };
  std::set<std::string> known;
  for (const ir::Kernel& kernel : module.kernels) {
    for (const ir::KernelParam& param : kernel.params) known.insert(parameterOf(param.name));
  }
  for (const bounds::NamedRange& range : ranges) {
    if (known.contains(parameterOf(range.name))) continue;
    messages << fmt::format("skc: --range: '{}' has no parameter '{}'; it has {}\n", module.file, range.name,
                            known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", ")));
    return false;
  }
  return true;
}

bool writeFile(const fs::path& path, const std::string& text, std::ostream& messages) {
  errno = 0;
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (out) return true;
  messages << fmt::format("skc: '{}' cannot be written: {}\n", path.string(),
                          std::strerror(errno ? errno : EIO));
  return false;
}

/// Escapes spaces and '$' for make.
std::string makeEscaped(const std::string& path) {
  std::string text;
  for (const char c : path) {
    if (c == ' ' || c == '#') text += '\\';
    if (c == '$') text += '$';
    text += c;
  }
  return text;
}

std::string fileName(const ir::Module& module) { return fs::path(module.file).filename().string(); }

emit::Targets targetsOf(const Options& options) {
  return {
      .fragment = options.fragmentTarget, .compute = options.computeTarget, .native = options.nativeTarget};
}

emit::Stub stubOf(const Options& options, const ir::Module& module) {
  return emit::emitStub(module, emit::Program(module, targetsOf(options)), fileName(module),
                        {.native = options.nativeTarget,
                         .quad = options.quad,
                         .includeDirectories = options.includeDirectories,
                         .withLibrary = options.library});
}

std::string nativeText(const Options& options, const ir::Module& module, native::Output output) {
  return native::compile(module, stubOf(options, module).native, compileLibrary, options.native, output);
}

/// Plans for each measured device; without any, for the profile.
std::string planListings(const Options& options, const ir::Module& module) {
  if (options.devices.empty()) {
    const sk::assemble::Profile& profile = *sk::assemble::findProfile(options.profile);
    return planListing(
        module, profile.name,
        {static_cast<std::uint32_t>(profile.drawBuffers), static_cast<std::uint32_t>(profile.textureUnits)});
  }
  std::string text;
  for (const MeasuredDevice& device : options.devices) {
    text += (text.empty() ? "" : "\n") + planListing(module, device.name, device.limits);
  }
  return text;
}

std::string boundsText(const Options& options, const ir::Module& module) {
  bounds::Options ofBounds = options.bounds;
  ofBounds.hasVariants = options.precision != "single";
  const std::vector<bounds::KernelBounds> kernels = bounds::boundsOf(module, ofBounds);
  return options.boundsAsJson ? bounds::json(kernels, options.bounds)
                              : bounds::listing(kernels, options.bounds);
}

web::JsModule jsModuleOf(const Options& options, const ir::Module& module) {
  return web::jsModule(module, emit::Program(module, {.fragment = true, .compute = false}), fileName(module),
                       options.shadow);
}

/// An output file and its contents.
struct OutputFile {
  std::string path;
  std::string text;
};

/// FILE.sk.hpp and FILE.sk.cpp, and FILE.sk.o for the native target; or FILE.sk.js and FILE.sk.d.ts. The object exists
/// even if no kernel has native code, because build rules name their outputs without reading the file.
std::vector<OutputFile> outputsOf(const Options& options, const ir::Module& module) {
  const std::string base = (fs::path(options.outputDirectory) / fileName(module)).string();
  if (options.emit == Emit::Js) {
    web::JsModule made = jsModuleOf(options, module);
    return {{base + ".js", std::move(made.script)}, {base + ".d.ts", std::move(made.types)}};
  }
  emit::Stub stub = stubOf(options, module);
  std::vector<OutputFile> files;
  files.push_back({base + ".hpp", std::move(stub.header)});
  files.push_back({base + ".cpp", std::move(stub.source)});
  if (options.nativeTarget) {
    files.push_back({base + ".o", native::compile(module, stub.native, compileLibrary, options.native,
                                                  native::Output::Object)});
  }
  return files;
}

bool writeOutputs(const Job& job, const ir::Module& module, const frontend::Frontend& frontend) {
  const Options& options = job.options;
  const std::vector<OutputFile> files = outputsOf(options, module);
  std::error_code error;
  fs::create_directories(options.outputDirectory, error);  // an error here shows when the files are written
  std::string rule;
  for (const OutputFile& file : files) {
    if (!writeFile(file.path, file.text, job.messages)) return false;
    rule += (rule.empty() ? "" : " ") + makeEscaped(file.path);
  }
  if (options.depfile.empty()) return true;
  rule += ":";
  for (const std::string& file : frontend.dependencies()) rule += " \\\n  " + makeEscaped(file);
  return writeFile(options.depfile, rule + "\n", job.messages);
}

/// Prints the result of predicate, which only the native target runs, on a copy of the module.
void printPredicated(const Job& job, const ir::Module& module) {
  const std::string& wanted = job.options.printAfter;
  if (wanted != predicateName && (wanted != "all" || !job.options.nativeTarget)) return;
  ir::Module copy = ir::clone(module);
  predicate(copy);
  job.output << "// after " << predicateName << "\n" << ir::print(copy) << "\n";
}

/// Reports the first pipeline that a module for browsers cannot have, since there only single kernels run.
void reportPipelines(const Options& options, const ir::Module& module, Diagnostics& diagnostics) {
  if (options.emit != Emit::Js) return;
  for (const ir::Pipeline& pipeline : module.pipelines) {
    if (pipeline.isKernel) continue;
    std::string calls;
    for (const ir::PipelinePass& pass : pipeline.passes) {
      for (const std::string& name : pass.calls) calls += (calls.empty() ? "'" : "', '") + name;
    }
    return diagnostics.report(Diag::PipelineInBrowser, pipeline.face.loc, {pipeline.face.name, calls + "'"});
  }
}

/// Warns of the first printf, and of the first assertion, that some of the programs leave out.
void reportLeftOut(const Options& options, const ir::Module& module, Diagnostics& diagnostics) {
  if (options.emit == Emit::Js && !module.assertions.empty())
    diagnostics.report(Diag::AssertLeftOut, module.assertions.front().loc);
  if (options.emit != Emit::Js && !options.fragmentTarget && !options.computeTarget) return;
  for (const ir::Function& function : module.functions) {
    std::optional<Loc> first;
    ir::walkStmts(function.body, [&](const ir::Stmt& stmt) {
      if (!first && std::holds_alternative<ir::Print>(stmt.node)) first = stmt.loc;
    });
    if (first) return diagnostics.report(Diag::PrintLeftOut, *first);
  }
}

/// Runs everything before the emitters; returns nullopt after errors.
std::optional<ir::Module> translate(const Job& job, frontend::Frontend& frontend) {
  const Options& options = job.options;
  noteActivity("parsing and lowering " + job.file);
  std::optional<ir::Module> module =
      frontend.compile(job.file, job.text == nullptr ? std::nullopt : std::optional(*job.text));
  if (!module || options.emit == Emit::Ast) return module;
  if (!checkRanges(*module, options.bounds.ranges, job.messages)) return std::nullopt;
  if (!options.kernel.empty() && !selectKernel(*module, options.kernel, job.messages)) return std::nullopt;
  checkLimits(*module, frontend.diagnostics());
  checkSizes(*module, frontend.diagnostics());
  checkOutputs(*module, frontend.diagnostics());  // before any transform: it checks the code as written
  if (!frontend.diagnostics().hasErrors()) {
    TransformOptions transforms = transformOptions(options, job.output);
    transforms.precisions =
        transforms.precisions || options.shadow || (options.emit == Emit::Js && wantsPrecisions(*module));
    runTransforms(*module, frontend.diagnostics(), transforms);
    if (!frontend.diagnostics().hasErrors())
      checkSizes(*module, frontend.diagnostics());  // unrolled loops are larger
  }
  if (!frontend.diagnostics().hasErrors() && wantsPerformanceWarnings(options.warnings)) {
    warnOfPerformance(*module, frontend.diagnostics());
  }
  if (!frontend.diagnostics().hasErrors()) reportPipelines(options, *module, frontend.diagnostics());
  if (!frontend.diagnostics().hasErrors()) reportLeftOut(options, *module, frontend.diagnostics());
  if (!frontend.diagnostics().hasErrors()) emit::reportOverloads(*module, frontend.diagnostics());
  if (options.emit == Emit::Stubs) emit::reportCppNames(*module, frontend.diagnostics());
  if (options.emit == Emit::Js) web::reportJsNames(*module, frontend.diagnostics());
  if (frontend.diagnostics().hasErrors()) return std::nullopt;
  noteActivity("output");
  printPredicated(job, *module);
  return module;
}

int compile(const Job& job) {
  const Options& options = job.options;
  frontend::Frontend frontend(frontendOptions(job));
  const std::optional<ir::Module> module = translate(job, frontend);
  if (options.emit == Emit::Ast) frontend.dumpAst(job.output);  // even if the program has errors
  if (!module) return 1;
  const bool writesFiles = options.emit == Emit::Stubs || options.emit == Emit::Js;
  if (writesFiles && job.text == nullptr) return writeOutputs(job, *module, frontend) ? 0 : 1;
  job.output << emitText(options, *module);
  job.output.flush();
  return job.output ? 0 : 1;
}

}  // namespace

int compile(const Options& options, const std::string& file) { return compile(Job{options, file}); }

std::string emitText(const Options& options, const ir::Module& module) {
  switch (options.emit) {
    case Emit::Ir: return ir::print(module);
    case Emit::Glsl: return glslListing(module, options.profile, options.precision);
    case Emit::Plan: return planListings(options, module);
    case Emit::Bounds: return boundsText(options, module);
    case Emit::Json:
      return emit::jsonText(module, emit::Program(module, targetsOf(options)), fileName(module));
    case Emit::Stubs: {
      const emit::Stub stub = stubOf(options, module);
      return stub.header + stub.source;
    }
    case Emit::Js: {
      const web::JsModule made = jsModuleOf(options, module);
      return made.script + made.types;
    }
    case Emit::Llvm: return nativeText(options, module, native::Output::Llvm);
    case Emit::Assembly: return nativeText(options, module, native::Output::Assembly);
    case Emit::Ast: break;  // printed from the frontend's tree, in translate()
  }
  return {};
}

Outcome compileText(const Options& options, const std::string& file, const std::string& text) {
  std::ostringstream output, messages;
  const int status = compile(Job{options, file, &text, output, messages});
  return {status, output.str(), messages.str()};
}

Translation translateText(const Options& options, const std::string& file, const std::string& text) {
  std::ostringstream output, messages;
  const Job job{options, file, &text, output, messages};
  frontend::Frontend frontend(frontendOptions(job));
  std::optional<ir::Module> module = translate(job, frontend);
  return {std::move(module), messages.str()};
}

}  // namespace skc::driver
