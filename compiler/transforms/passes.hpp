// SPDX-License-Identifier: MIT
//
// The passes that transforms.cpp runs, in its order, each with a program before and after. A pass is defined in the file of its
// name. Where other passes need a part of a pass for one function or kernel, it is declared below the pass.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

/// specialize-gathers: copies each function for each kernel and each choice of streams that it is called with,
/// because GLSL functions cannot take streams.
///
///   before   float sum3(float a[], int i) { return a[i - 1] + a[i] + a[i + 1]; }
///            kernel void f(float u[], float v[], out float r<>) { r = sum3(u, 7) + sum3(v, 7); }
///   after    float sum3_u(int i) { return $0[i - 1] + $0[i] + $0[i + 1]; }
///            float sum3_v(int i) { return $1[i - 1] + $1[i] + $1[i + 1]; }
///            void f(out float r) { r = sum3_u(7) + sum3_v(7); }
///
/// Afterwards every StreamRef names a parameter of the kernel or its domain, only entries have stream
/// parameters, each function belongs to one kernel, and callees precede their callers. An element parameter
/// whose argument is not an element has the domain's index.
void specializeGathers(ir::Module& module, Diagnostics& diagnostics);

/// expand-powers: computes squares as products, which are rounded correctly and take a tenth of the time.
///
///     v = pow(a - b, 2.0);         v = (a - b) * (a - b);
void expandPowers(ir::Module& module, Diagnostics& diagnostics);

/// tabulate: gives each table of a function, if some kernel may use it, a kernel that computes the function, from which the
/// runtime fills the table. Calls are not changed: the assembler turns them into look-ups.
void tabulate(ir::Module& module, Diagnostics& diagnostics);

/// fold-constants: computes what is known, and removes branches that are never taken. It prefers safety to
/// completeness: a value is computed only if every device would compute the same one, and constants keep their
/// names, since the driver folds the rest and people read the GLSL.
///
///   before   const bool periodic = false;
///            v = (2.0 * 0.5 - 1.0) * x;  if (periodic && x > 0.0) v = wrapped(x); else v = 2.0 * pi * x;
///   after    const bool periodic = false;
///            v = 0.0 * x;  v = 2.0 * pi * x;
///
/// A vector's component with a known index gets its name, `a[1]` becomes `a.y`, so that later transforms treat
/// folded and written components alike.
void foldConstants(ir::Module& module, Diagnostics& diagnostics);

/// Folds constants in a function into which another transform has substituted literals, except for float
/// arithmetic, whose results must stay those of the device, and of the variants in double. It also computes
/// locals that always hold a known integer, integer vectors, and elements of constant arrays.
void foldIntegers(const ir::Module& module, ir::Function& function);

/// unroll-spec-loops: gives each kernel whose loops are bounded by an integer spec parameter a variant for each small
/// value of it, in which unroll-loops has unrolled them all.
///
///   before   kernel void blur(spec int n, float a[], out float r<>) {
///              for (int i = -n; i <= n; ++i) r += neighbor(a, i);
///            }
///   after    the same, with the variants
///            { r += neighbor(a, -1);  r += neighbor(a, 0);  r += neighbor(a, 1); }    for n = 1
///            ...                                                                       for n = 2
///
/// Variants compute the same. Calls with another value run the kernel as it is.
void unrollSpecLoops(ir::Module& module, Diagnostics& diagnostics);

/// The values that have variants begin with 1 and end here, or earlier: all variants of a kernel together have at most
/// mostUnrolledExpressions.
constexpr std::uint32_t mostUnrolledValue = 8;

/// unroll-loops: unrolls short counted loops if that makes offsets of neighbours and indices of arrays
/// constant, or if the code hardly grows. Only if every offset is known can outputs be packed, and neighbours
/// be fetched once for all of them.
///
///   before   for (int dy = -1; dy <= 1; ++dy)
///              for (int dx = -1; dx <= 1; ++dx) {
///                if (dx == 0 && dy == 0) continue;
///                float w = weight[dx + 1];
///                sum += w * neighbor(a, dx, dy);
///              }
///   after    { float w = weight[0];  sum += w * neighbor(a, -1, -1); }
///            { float w = weight[1];  sum += w * neighbor(a, 0, -1); }  ...
///
/// `weight[0]` is replaced by the element of the constant array, and integers are computed; float arithmetic
/// keeps its order, so that no result changes. A loop that elements may leave early stays a loop.
/// Kernel::loops records what became of each loop, and why.
void unrollLoops(ir::Module& module, Diagnostics& diagnostics);

/// Unrolls the loops of one kernel, which may not be in the module yet.
void unrollLoops(ir::Module& module, ir::Kernel& kernel);

/// Limits: iterations of a loop including the loops in it, and expressions in all unrolled loops of a kernel.
constexpr std::int64_t mostUnrolledIterations = 64;
constexpr std::int64_t mostUnrolledExpressions = 1000;

/// find-neighbors: turns a gather at the current index plus constants into a read of a neighbour, whose
/// distance is known: this enables aligned texels, packed outputs and contiguous loads. Both mean the same for
/// every boundary mode and shape of the gather, because a neighbour's offset is relative to the domain's
/// index.
///
///   before   int2 p = indexof(r).xy;  r = a[p.y + 1][p.x - 1];
///   after    int2 p = indexof(r).xy;  r = neighbor(a, -1, 1);
///
/// It skips reduces, whose result is smaller than the domain of their neighbours.
void findNeighbors(ir::Module& module, Diagnostics& diagnostics);

/// find-reach: notes beside each gather of a declared kernel how far from its own element the kernel reads it.
///
///   kernel void blur(float u[], out float r<>) {   // u: x 1 before, 2 after
///     int x = indexof(r).x;
///     r = u[x - 1] + u[x + 2];
///   }
///
/// Where that is not known, the author's promise counts: [[halo(2)]]. A promise that is known to be broken is an error.
void findReach(ir::Module& module, Diagnostics& diagnostics);

/// guard-streams: finds for each stream of a kernel the values of the spec parameters for which the kernel
/// uses it, from the branches around its uses. It changes no function.
///
///   kernel   f: entry @0                           f: entry @0
///              $0 bent: spec bool                    $0 bent: spec bool
///              $1 light: gather float rank 1         $1 light: gather float rank 1 if bent
///              $2 r: output float                    $2 r: output float
///   body     r = bent ? $1[0] : 0.0;
///
/// What it cannot analyse counts as a use: a condition may be true too often, never false for a used stream.
void guardStreams(ir::Module& module, Diagnostics& diagnostics);

/// bound-pushes: determines the operation of each scatter output, and how many elements one element of the
/// domain pushes or scatters at most, so that small bounds need no readback.
///
///   kernel void split(float x<>, vout float r<>) {   // r: at most 2
///     push(r, x);
///     if (x > 0) push(r, -x);
///   }
///
/// A branch counts as the larger of its sides, a loop with a known trip count as that many times its body, any
/// other loop as unknown. A scatter output with two kinds of operation is an error, because the device does
/// one kind per pass.
void boundPushes(ir::Module& module, Diagnostics& diagnostics);

/// inline-folds: inlines the helper functions and kernels through which a reduce folds, if that reveals the
/// operator. The meaning of a fold then does not depend on how its code is divided into functions.
///
///   before   float join(float a, float e, float c) { return a + e + c; }
///            reduce void bar(float a<>, float c, reduce float e<>) { e = join(a, e, c); }
///   after    reduce void bar(float a<>, float c, reduce float e<>) { e = a + e + c; }
///
/// A reduce whose operator stays unknown is not changed.
void inlineFolds(ir::Module& module, Diagnostics& diagnostics);

/// derive-combine: determines how the partial results of each reduce combine, which every parallel fold needs.
///
///   before   reduce void sumSquares(float x<>, reduce float total<>) { total += x * x; }
///   after    the same, with identity 0 and
///            reduce void sumSquares_combine(float total_part<>, reduce float total<>) { total += total_part; }
///
/// Cases, in this order:
///   * The author wrote an overload that folds accumulators: it stays.
///   * The body folds by known operators (fold_pattern.hpp). `total += x` on x itself combines its own
///     results; any other gets a reduce `accumulator op= part`, member by member. Subtraction and
///     division are errors: their partial results do not combine.
///   * The elements and the accumulators have the same types, one by one: the reduce combines its own
///     results, since the language requires the operation to be associative.
///   * Otherwise the author has to write that overload.
/// A combining reduce must not ask where an element is: a partial result has no index. All folds are then tried on
/// numbers (fold_trial.hpp), so that no result depends on how the device divides the elements, but for rounding.
///
/// Identities and -0. If the author gives an identity, every run of elements starts from it, as written: the
/// sum of a stream of -0 with `= 0` is 0 + -0 = +0, as in C++, and `max` with `= -inf` drops NaN wherever the
/// device's max does. Otherwise the fold starts with its first element (`seeded`): the sum of -0 is -0, and
/// one NaN stays NaN. An identity is then supplied for known operators, so that an empty stream has a value;
/// for sums it is +0, the value that IEEE 754-2019 9.4 gives an empty sum, although -0 would be the neutral
/// element. If the fold cannot start with an element (x * x, or another type), runs start with the supplied
/// identity, and a sum of only -0 gives +0.
void deriveCombine(ir::Module& module, Diagnostics& diagnostics);

// split-folds follows (split/passes.hpp).

/// widen-floats: gives each kernel and reduce of floats a wide variant, which computes in double (the device's
/// own, or pairs of floats) wherever the kernel says float. Its streams still hold floats.
///
///   before   kernel void blend(float t, float a<>, float b[], out float r<>) { r = a + t * b[0]; }
///   after    the same, with the wide variant
///            kernel void blend(float t, double a<> held as float, double b[] held as float,
///                              out double r<> held as float) {
///              double t_wide = double(t);
///              r = a + t_wide * b[0];
///            }
///
/// Literals get the value of their text, which wideValue() reads. Values that are scattered or pushed are
/// rounded to float there. A reduce's accumulators are doubles between its passes, and
/// a kernel `finish` rounds them to float at the end. A kernel that uses what doubles do not support, such as
/// matrices, has no wide variant, and records why.
void widenFloats(ir::Module& module, Diagnostics& diagnostics);

/// round-halves: gives each kernel and reduce of floats a variant that computes in half precision: every float
/// that is read or computed is rounded to the nearest half.
///
///   before   kernel void blend(float t, float a<>, float b[], out float r<>) { r = a + t * b[0]; }
///   after    the same, with the variant
///            kernel void blend(float t, float a<>, float b[], out float r<>) {
///              float t_half = half(t), a_half = half(a);
///              r = half(a_half + half(t_half * half(b[0])));
///            }
///
/// Literals are rounded from their text, and constants computed in halves.
///
/// Float has at least two more bits than twice those of half, so + - * / and sqrt give the results of IEEE
/// 754's binary16 (Figueroa, When is double rounding innocuous?, 1995); other functions are rounded once more.
void roundHalves(ir::Module& module, Diagnostics& diagnostics);

/// compensate-sums: gives each reduce that sums floats a variant that also sums the rounding errors of the
/// first sum.
///
///   before   reduce void squares(float x<>, reduce float total<> = 0) { total += x * x; }
///   after    the same, compensated by
///            reduce void squares(float x<>, reduce float total<> = 0, reduce float total_lost<> = 0) {
///              float term = roundedProduct(x, x);
///              total_lost += sumError(total, term) + productError(x, x);
///              total = roundedSum(total, term);
///            }
///            reduce void squares_combine(float total_part<>, reduce float total<>, float total_lost_part<>, reduce float
///                                        total_lost<>) {
///              total_lost += total_lost_part;
///              total_lost += sumError(total, total_part);
///              total = roundedSum(total, total_part);
///            }
///            kernel void squares_finish(float total<>, float total_lost<>, out float r_total<>) {
///              r_total = isfinite(total_lost) ? total + total_lost : total;
///            }
///
/// sumError is the error of a float addition, itself a float, and productError the error of a multiplication
/// (Dekker, Numer. Math. 18, 1971). A sum of n terms (float_sums.hpp) then has one rounding of its own and an
/// error of 2 (d + 1)^2 u^2 times the sum of magnitudes, in a tree of depth d: Sum2 and Dot2 of Ogita, Rump and Oishi (SIAM J.
/// Sci. Comput. 26, 2005) over a tree. float_sums.hpp defines which accumulators and members are such sums;
/// all others are folded and combined as before, possibly by the author's own reduce. A reduce without
/// identities has no variant. If an element adds only one input or the product of two, a double holds that
/// term, and native code sums in doubles.
void compensateSums(ir::Module& module, Diagnostics& diagnostics);

/// sum-exactly: gives each scalar of a reduce's accumulators that is a sum of floats a variant that adds
/// without rounding, to an integer with a position for every bit of every float (a superaccumulator: Kulisch,
/// Computer Arithmetic and Validity, 2008). The order of summands does not change the sum, which is rounded
/// once.
///
///   before   reduce void dot(float x<>, float y<>, reduce float total<>) { total += x * y; }
///   after    the same, exactly by
///            reduce void dot_exact(float x<>, float y<>, reduce int4 digits_0<> = 0, ..., reduce int flags<> = 0) {
///              digits_0 += exactProductDigits(x, y, 0); ...  flags |= exactProductFlags(x, y);
///            }
///            kernel void dot_finish(float total<>, int4 digits_0<>, ..., int flags<>, out float r_total<>) {
///              r_total = exactRounded(digits_0, ..., flags, base);
///            }
///   and, once per file, the reduce that combines digits.
///
/// The digits of a product of two floats are exact, and take twice as many positions; other summands
/// (float_sums.hpp) are rounded to float first. Digits have room for the terms of a run whose elements add one each
/// (sk/exact_digits.hpp); an element that may add more settles its digits. All arithmetic is on integers, on which all
/// devices agree.
///
/// Native code does not fold digits: the runtime adds terms to an accumulator of its own. ExactSum::term
/// describes the terms.
void sumExactly(ir::Module& module, Diagnostics& diagnostics);

/// sum-in-doubles: gives kernels that sum floats beside their outputs a native variant whose sums are doubles. It costs
/// a fraction of a compensated sum, and is more exact.
///
///   before   kernel void step(float q<>, float r<>, out float s<>, reduce float ss<> = 0) { s = r - q; ss += s * s; }
///   after    the same, natively folded by
///            kernel void step(float q<>, float r<>, out float s<>, reduce double ss<> = 0) {
///              s = r - q;
///              ss += double(s) * double(s);
///            }
///            reduce void step_combine(double ss_part<>, reduce double ss<>) { ss += ss_part; }
///            kernel void step_finish(double ss<>, out float r_ss<>) { r_ss = float(ss); }
///
/// A double holds each term (float_sums.hpp), a float or the product of two. All else is computed in floats: the outputs
/// keep their bits. A kernel with sums in members of accumulators, or that folds more into a sum, has no such variant.
///
/// It sets FoldParts::inDoubles.
void sumInDoubles(ir::Module& module, Diagnostics& diagnostics);

/// assign-rows: writes to a part of a matrix's row go through a variable, which is then assigned to the whole row, if the row's
/// index, or that of the matrix in an array, is computed.
///
///   m[i].x = 1.0;        float3 m_row = m[i];
///                        m_row.x = 1.0;
///                        m[i] = m_row;
///
/// It preserves the meaning of kernels. NVIDIA's GLSL compiler (seen on an H100) loses the write on the left
/// if the same function reads a component at two computed indices, `m[i][j]`, and stores `a[i][1].x = 1.0` in an array of
/// matrices outside of the program's memory (580, seen on an H200); it keeps writes of whole rows.
void assignRows(ir::Module& module, Diagnostics& diagnostics);

/// forward-continues: makes a `continue` in nested switches leave one switch at a time. Drivers take it for
/// the outer switch's break, or run the step of a `for` once too often (Mesa 22.3).
///
///   for (int i = 0; i < n; ++i) {            for (int i = 0; i < n; ++i) {
///     switch (a) {                             switch (a) {
///       case 0: {                                case 0: {
///                                                  bool continues = false;
///         switch (b) {                             switch (b) {
///           case 1: continue;                        case 1: { continues = true; break; }
///         }                                        }
///                                                  if (continues) continue;
///         r = 0;                                   r = 0;
///       }                                        }
///     }                                        }
///   }                                        }
void forwardContinues(ir::Module& module, Diagnostics& diagnostics);

/// copy-parts: a function that writes a part of a part of a variable gets a variable of its own, if the call has an expression, too.
///
///   f(s.items[i], g(x));       float part = s.items[i];
///                              f(part, g(x));
///                              s.items[i] = part;
///
/// NVIDIA's GLSL compiler (580, seen on an H200) loses what the function on the left writes if `s` was copied from another
/// struct and it expands a function in the arguments, such as g or clamp().
///
/// It preserves the meaning of kernels: such parameters are copied in and out anyway. The lvalues that a call writes do not
/// overlap, and no index in them reads what it writes (ir::validate), so that the assignment finds the place again.
void copyParts(ir::Module& module, Diagnostics& diagnostics);

/// expand-selects: `?:` of structs, of arrays and of doubles, which may be pairs of floats, becomes a branch. WebGL
/// forbids it ("ternary operator is not allowed for structures"); only the profile webgl2 needs this.
///
///   best = h.t < best.t ? h : best;      Hit chosen;
///                                        if (h.t < best.t) chosen = h; else chosen = best;
///                                        best = chosen;
///
/// Either side is evaluated only where it was before. A choice by component, as between two double2, stays: the
/// assembler defines it for each component.
void expandSelects(ir::Module& module);

/// remove-unused: removes functions, constants, types and locals that no kernel needs, and assignments to such
/// locals. An expression has no side effect and may go; a call that writes to other variables stays.
///
///   before   float twice(float x) { return x + x; }
///            kernel void f(float x<>, out float r<>) { float a = exp(x); a += 1.0; r = x; }
///   after    kernel void f(float x<>, out float r<>) { r = x; }
void removeUnused(ir::Module& module, Diagnostics& diagnostics);

// split-kernels follows (split/passes.hpp).

}  // namespace skc
