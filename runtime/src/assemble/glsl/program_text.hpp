// SPDX-License-Identifier: MIT
//
// Builds a program: sections to which declarations are added on first use, and which finally surround the
// kernel's own text.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/relayed_values.hpp"

namespace sk::assemble {

/// The work group for texels of 16 bytes. Texels are stored in square tiles, and groups that cover whole
/// tiles, in columns, are fastest; smaller groups take a large GPU longer to start than to run.
inline constexpr std::pair<int, int> groupOfWideTexels{8, 16};
/// The shared memory that a work group may use on any device.
inline constexpr std::size_t groupBytes = 32768;

/// The assembler's own shared functions; functions.cpp has their text.
enum class Function : std::uint8_t {
  /// The index of an element number in 2, 3 or 4 dimensions; the highest one required serves for all.
  Unravel2,
  Unravel3,
  Unravel4,
  Ravel,  ///< element number of an index
  Texel,  ///< texel of an element number
  Paired,  ///< number of the element that is fetched or stored in another's place, to cover two rows of texels at once
  Divide,  ///< quotient of an element number
  Row,  ///< texel of an element number in a plane; requires Divide
  Layered,  ///< texel of a layered texture
  Wrap,  ///< wrapped sum of an index and an offset
  WrapOnce,  ///< wrapped index that is less than an extent out of bounds
  Mirror,
  MirrorOnce,
  ToHalf,  ///< rounds a float to half, as a float
  Ramp,  ///< element of an iterator of floats
  Local,  ///< position of an invocation in its work group, groupOfWideTexels
  Sampled,  ///< texel of a 2-D texture, sampled at its centre
};
std::string_view text(Function function);

/// Whether the programs of a profile must declare the formats of the images that they write.
inline bool declaresFormats(const Profile& profile) { return profile.es && profile.stage == Stage::Compute; }

class ProgramText {
 public:
  ProgramText() = default;  ///< of a draw
  explicit ProgramText(const Profile& profile)
      : stage_(profile.stage),
        declaresFormats_(declaresFormats(profile)),
        sharesTexels_(profile.sharesTexels),
        samples_(profile.samples) {}

  Stage stage() const { return stage_; }
  bool sharesTexels() const { return sharesTexels_ && stage_ == Stage::Compute; }
  /// Profile::samples
  bool samples() const { return samples_; }
  /// The texel of the invocation, an ivec2, and its coordinates, as expressions.
  std::string_view texel() const { return isDrawn() ? "ivec2(gl_FragCoord.xy)" : "sk_pixel"; }
  std::string_view column() const { return isDrawn() ? "int(gl_FragCoord.x)" : "sk_pixel.x"; }
  std::string_view row() const { return isDrawn() ? "int(gl_FragCoord.y)" : "sk_pixel.y"; }
  /// Lets the vertex program relay all further uniforms that fit.
  void relayUniforms() { relaysUniforms_ = true; }
  const std::vector<RelayedValue>& relayed() const { return relayed_.all(); }
  /// Declares a uniform on first use, and returns the name by which the program reads it.
  std::string uniform(std::string_view type, std::string_view name);
  /// Declares an input that is constant over a point or triangle.
  void flatInput(std::string_view type, std::string_view name);
  /// Declares the output of the next location: a variable of a texel type. `format` is that of its image, imageFormat();
  /// empty: of 32 bits, with as many components as the type.
  void output(std::string_view type, std::string_view name, std::string_view format = {});
  /// Sets where a compute program stores its outputs at the end of main(): an ivec2, or an ivec3 in array
  /// textures.
  void storeAt(std::string_view place, bool isArray);
  /// Stores the outputs in the buffer at binding 0 instead: 16 bytes each, as four components.
  void storeInBuffer();
  /// For compute programs: a work group of this size computes one texel, which its first invocation stores. If it
  /// `storesApart`, each invocation that does not return stores a texel of its own.
  void dispatchGroups(std::int32_t width, std::int32_t height, bool storesApart = false);
  struct Output {
    std::string type, name;
    bool isStoredLater = false;
    std::string atomicFormat = {};  ///< empty: the image is only written
    std::string format = {};  ///< of the image
  };
  const Output& outputAt(std::size_t number) const { return outputs_[number]; }
  /// The number of outputs so far, which is the binding of the next one's image.
  std::size_t outputCount() const { return outputs_.size(); }
  /// Outputs from number `first` on are stored where storesOf() says, not at the end of main().
  void storeLater(std::size_t first);
  /// The image of this output is read and written, with this format ("r32i").
  void makeAtomic(std::size_t output, std::string_view format);
  /// Statements that store outputs from number `first` up to `end` at texel `place`.
  std::vector<std::string> storesOf(std::size_t first, std::size_t end, std::string_view place) const;
  /// For compute programs: main() becomes the function `sk_run`, and the program ends with `main` in its place.
  void runFrom(std::string main) { mainOfGroups_ = std::move(main); }
  /// For compute programs that fold (reduce/group_fold.hpp): main() becomes the function `sk_run`, which a work group calls
  /// for each tile of texels, between the lines `before` and `after`.
  void foldTiles(std::pair<int, int> group, std::vector<std::string> before, std::vector<std::string> after);
  /// The size of a work group whose invocations compute a texel of the first output each.
  std::pair<int, int> groupOfTexels() const;
  /// For compute programs whose invocations store any number of texels: the statements that store the outputs' present
  /// values at a place, an ivec2, or an ivec3 in array textures. main() stores nothing by itself then.
  std::vector<std::string> storing(std::string_view place, bool isArray);
  /// The #extension lines that the program needs besides those of its types; each ends its line.
  void extensions(std::string_view lines) { extensions_ = lines; }
  /// Declares a buffer at binding 0, "buffer name {...}", with qualifiers.
  void buffer(std::string_view declaration);
  /// Declares a global variable.
  void variable(std::string_view type, std::string_view name);
  /// Defines a shared function on first use.
  void require(Function function);
  /// Defines a function, unless this signature has been defined.
  void function(std::string_view signature, const std::vector<std::string>& statements);
  bool isDefined(std::string_view signature) const;
  /// Adds the text of functions, once.
  void functions(std::string_view text) {
    if (functions_.find(text) == std::string::npos) functions_ += text;
  }
  /// Defines a function with the lines that `write` adds by statement().
  template <class Write>
  void functionOf(std::string_view signature, Write&& write) {
    std::string lines = std::exchange(main_, {});
    write();
    std::swap(lines, main_);
    defineWith(signature, lines);
  }
  /// The lines that `write` adds by statement(), which main() does not get.
  template <class Write>
  std::vector<std::string> linesOf(Write&& write) {
    std::string text = std::exchange(main_, {});
    write();
    std::swap(text, main_);
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = text.find('\n', at);
      lines.push_back(text.substr(at + 2, end - at - 2));  // without the indent of main()
      at = end + 1;
    }
    return lines;
  }
  /// Adds a line to main().
  void statement(std::string_view line);
  /// Adds a line to main() that precedes all lines of statement().
  void prologue(std::string_view line);
  /// Adds a line to main() of a compute program that precedes all of these, and that all invocations of a
  /// work group run, including those outside the domain. A barrier follows these lines and those of
  /// keepTogether(). Function::Local then gives the position of invocations.
  void together(std::string_view line);
  /// Adds a line after all of together(), so that a group starts all fetches before it stores their results.
  void keepTogether(std::string_view line);
  /// Allocates shared memory of a work group; false if there is not enough left.
  bool takeShared(std::size_t bytes);
  /// Adds text of skc after the kernel's own.
  void foreign(std::string_view text);
  /// The program may take many iterations of loops, whatever its kernel says (Profile::checksLoops).
  void takeManyIterations() { takesManyIterations_ = true; }
  /// What is stored as doubles and read as floats may be denormal floats, whatever the device makes of these.
  void keepDenormals() { keepsDenormals_ = true; }
  bool keepsDenormals() const { return keepsDenormals_; }

  /// Declarations and functions of the assembler's own, with marks.
  std::string ownText() const;
  /// The lines of main() that statement() has added.
  const std::string& statements() const { return main_; }
  /// The whole program. `comment` is its first line, without the slashes.
  std::string finish(const Profile& profile, std::string_view comment, const program::Kernel& kernel) const;

 private:
  std::string storeOf(std::size_t output, std::string_view place) const;
  void defineWith(std::string_view signature, std::string_view lines);
  bool isDrawn() const { return stage_ == Stage::Fragment; }
  std::string declarationOfOutputs() const;
  std::string declarationOfBuffer() const;
  std::string extensionsOfImages(const Profile& profile) const;
  std::string mainOf(const std::string& body) const;
  std::string mainOfTiles(const std::string& body) const;
  std::string storesAtEnd() const;

  Stage stage_ = Stage::Fragment;
  bool declaresFormats_ = false;
  bool sharesTexels_ = false;
  bool samples_ = false;
  std::string place_;  ///< of storeAt()
  std::string mainOfGroups_;  ///< of runFrom()
  bool keepsDenormals_ = false;
  bool takesManyIterations_ = false;
  std::vector<std::string> beforeTiles_, afterTiles_;  ///< of foldTiles()
  std::pair<int, int> groupOfTiles_{};  ///< likewise; 0: it does not fold
  bool isArray_ = false;
  bool isInBuffer_ = false;  ///< storeInBuffer()
  bool storesApart_ = false;  ///< dispatchGroups()
  std::pair<std::int32_t, std::int32_t> group_{};  ///< the size for each texel; 0: one invocation per texel
  bool relaysUniforms_ = false;
  RelayedValues relayed_;
  std::vector<std::string> uniforms_;
  std::vector<Output> outputs_;
  std::string extensions_;
  std::vector<std::string> variables_;
  std::vector<std::string> signatures_;
  std::uint32_t used_ = 0;  ///< bits of Function
  std::string functions_;
  std::string together_;
  std::string keptTogether_;
  std::string prologue_;
  std::string main_;
  std::string foreign_;
  std::size_t shared_ = 0;  ///< bytes
};

/// The #extension line of a program that writes images of these formats, which ends its line; or nothing.
std::string_view formatExtension(const Profile& profile, std::span<const std::string> formats);
/// The statements that give all types of a program of ES their precision; nothing for other profiles.
std::string precisionStatements(const Profile& profile);

/// `name(arguments)` on one line, or with one line per argument if that is too long.
std::string call(std::string_view name, const std::vector<std::string>& arguments, std::string_view indent);

}  // namespace sk::assemble
