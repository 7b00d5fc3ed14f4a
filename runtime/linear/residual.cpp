// SPDX-License-Identifier: MIT
#include "residual.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "layout.hpp"
#include "residual.sk.hpp"
#include "vectors.sk.hpp"

namespace sk::linear {

namespace {

bool isExact(double v, sk::Storage storage) {
  switch (storage) {
    case sk::Storage::Half:
      return std::abs(v) <= 65504.0 && std::ldexp(std::round(std::ldexp(v, 24)), -24) == v &&
             (v == 0.0 || std::ldexp(v, 10 - std::ilogb(v)) == std::round(std::ldexp(v, 10 - std::ilogb(v))));
    case sk::Storage::Default:
    case sk::Storage::Single: return static_cast<double>(static_cast<float>(v)) == v;
    case sk::Storage::Extended:
    case sk::Storage::Double: return true;
  }
  return false;
}

/// Matrices whose sum is a.scale * A, exactly: coefficients of stencils are floats, and what they leave is another stencil's.
std::vector<std::unique_ptr<Matrix>> exactMatrices(sk::Device& device, const Matrix& matrix,
                                                   const Operator& a, const Arithmetic& arithmetic) {
  std::vector<std::unique_ptr<Matrix>> sum;
  if (matrix.layout() == "stencil" && a.varying != nullptr) {
    if (arithmetic.matrix != sk::Storage::Double)
      sum.push_back(makeMatrix(matrix.space(device), scaled(*a.varying, a.scale), doubleArithmetic()));
    return sum;
  }
  if (matrix.layout() == "stencil") {
    Stencil left = scaled(*a.stencil, a.scale);
    for (int part = 0; part < 3; ++part) {
      sum.push_back(makeMatrix(matrix.space(device), left, doubleArithmetic()));
      const auto subtract = [](double& c) { c -= static_cast<double>(static_cast<float>(c)); };
      subtract(left.centre);
      std::ranges::for_each(left.along, subtract);
      if (left.centre == 0.0 && std::ranges::all_of(left.along, [](double c) { return c == 0.0; })) break;
    }
    return sum;
  }
  if (!keepsEntries(a, arithmetic.matrix))
    sum.push_back(makeMatrix(device, scaled(sparseOf(a), a.scale), matrix.layout(), doubleArithmetic()));
  return sum;
}

/// A vector of the name by which `sk tune` knows the solution; without one if it is divided.
Vector solutionIn(const Space& space) {
  constexpr sk::Storage storage = sk::Storage::Double;
  if (space.isDivided()) return space.stream<float>(storage);
  return {space.device().stream<float>(space.shape(), storage, "linear::x"), storage};
}

class DeviceResidual : public Residual {
 public:
  DeviceResidual(sk::Device& device, Matrix& matrix, const Operator& a, const Arithmetic& arithmetic)
      : device_(device),
        matrix_(matrix),
        a_(a),
        arithmetic_(arithmetic),
        exact_(exactMatrices(device, matrix, a, arithmetic)),
        options_(doubleArithmetic().options()),
        foldOptions_(doubleArithmetic().foldOptions()) {
    const Space space = matrix.space(device);
    for (Vector* v : {&b_, &r_, &rNext_}) *v = space.stream<float>(sk::Storage::Double);
    for (Vector* v : {&x_, &xNext_}) *v = solutionIn(space);
    if (exact_.size() > 1) q_ = space.stream<float>(sk::Storage::Double);
    for (Vector* v : {&rr_, &xx_, &largestR_, &largestX_})
      *v = device.stream<float>({1}, sk::Storage::Double);
    if (space.isDivided()) whole_ = space.undivided().stream<float>(sk::Storage::Double);
  }

  void update() override {
    if (a_.sparse != nullptr && exact_.size() == 1)
      exact_[0]->update(scaled(*a_.sparse, a_.scale));
    else
      exact_ = exactMatrices(device_, matrix_, a_, arithmetic_);
  }

  Norms start(std::span<const double> b) override {
    hostB_.assign(b.begin(), b.end());
    b_.writeReals(b);
    x_.fill(0.0f);
    largest_ = 0.0;
    xNext_.fill(0.0f);
    residualOf.with(foldOptions_)(b_, xNext_, r_, rr_, largestR_);
    const Norms norms = normsIfExact();
    normB_ = norms.two;
    return norms;
  }

  Norms attempt(const Vector& step, double scale) override {
    addStep.with(foldOptions_)(static_cast<float>(scale), step, x_, xNext_, largestX_, xx_);
    multiply();
    residualOf.with(foldOptions_)(b_, rNext_, rNext_, rr_, largestR_);
    Norms norms = normsIfExact();
    norms.error += roundingOfResidual(a_, a_.scale * boundOfNorm(a_), std::sqrt(xx_.readReals()[0]), normB_);
    isOfHost_ = !isKnown(norms);
    if (!isOfHost_) return norms;
    const PreciseResidual precise = preciseResidual(a_, a_.scale, elementsOf(xNext_), hostB_);
    rNext_.writeReals(precise.r);
    return precise.norms;
  }

  void accept() override {
    std::swap(x_, xNext_);
    std::swap(r_, rNext_);
    largest_ = largestX_.readReals()[0];
  }

  void writeTo(Vector& r, double scale) override { scaleTo.with(options_)(static_cast<float>(scale), r_, r); }

  double largestOfSolution() const override { return largest_; }
  std::vector<double> solution() override { return x_.readReals(); }
  std::string_view place() const override { return isOfHost_ ? "host" : "device"; }

 private:
  /// rNext_ = A xNext_
  void multiply() {
    if (exact_.empty()) return matrix_.multiplyIn(doubleArithmetic(), xNext_, rNext_);
    exact_[0]->multiply(xNext_, rNext_);
    for (std::size_t i = 1; i < exact_.size(); ++i) {
      exact_[i]->multiply(xNext_, q_);
      axpy.with(options_)(1.0f, q_, rNext_, rNext_);
    }
  }

  /// If the elements of the residual are.
  Norms normsIfExact() const {
    const double two = std::sqrt(rr_.readReals()[0]);
    return {two, largestR_.readReals()[0], (static_cast<double>(a_.size) + 8.0) * 0x1p-53 * two};
  }
  /// On every rank.
  std::vector<double> elementsOf(const Vector& v) {
    if (!v.isDivided()) return v.readReals();
    v.copyTo(whole_);
    return whole_.readReals();
  }

  sk::Device& device_;
  Matrix& matrix_;
  const Operator& a_;
  Arithmetic arithmetic_;
  std::vector<std::unique_ptr<Matrix>> exact_;
  sk::CallOptions options_, foldOptions_;
  Vector b_, x_, xNext_, r_, rNext_, q_, rr_, xx_, largestR_, largestX_;
  Vector whole_;  ///< of vectors that are divided over ranks, all elements
  std::vector<double> hostB_;
  double largest_ = 0.0, normB_ = 0.0;
  bool isOfHost_ = false;
};

class HostResidual : public Residual {
 public:
  HostResidual(const Operator& a, const Space& space, sk::Storage storage) : a_(a) {
    if (space.isDivided()) whole_ = space.undivided().stream<float>(storage);
  }

  void update() override {}

  Norms start(std::span<const double> b) override {
    b_.assign(b.begin(), b.end());
    r_ = b_;
    x_.assign(b.size(), 0.0);
    const Norms norms = normsOf(r_);
    normB_ = norms.two;
    return norms;
  }

  Norms attempt(const Vector& step, double scale) override {
    next_ = elementsOf(step);
    for (std::size_t i = 0; i < next_.size(); ++i) next_[i] = x_[i] + scale * next_[i];
    rNext_ = a_.multiply(next_);
    for (std::size_t i = 0; i < next_.size(); ++i) rNext_[i] = b_[i] - a_.scale * rNext_[i];
    Norms norms = normsOf(rNext_);
    norms.error += roundingOfResidual(a_, a_.scale * boundOfNorm(a_), normsOf(next_).two, normB_);
    if (isKnown(norms)) return norms;
    PreciseResidual precise = preciseResidual(a_, a_.scale, next_, b_);
    rNext_ = std::move(precise.r);
    return precise.norms;
  }

  void accept() override {
    x_ = std::move(next_);
    r_ = std::move(rNext_);
  }

  void writeTo(Vector& r, double scale) override {
    std::vector<double> scaledR = r_;
    for (double& v : scaledR) v *= scale;
    r.writeReals(scaledR);
  }

  double largestOfSolution() const override { return normsOf(x_).infinity; }
  std::vector<double> solution() override { return x_; }
  std::string_view place() const override { return "host"; }

 private:
  /// On every rank.
  std::vector<double> elementsOf(const Vector& v) {
    if (!v.isDivided()) return v.readReals();
    v.copyTo(whole_);
    return whole_.readReals();
  }

  const Operator& a_;
  Vector whole_;  ///< of vectors that are divided over ranks, all elements
  std::vector<double> b_, x_, r_, next_, rNext_;
  double normB_ = 0.0;
};

}  // namespace

bool keepsEntries(const Operator& a, sk::Storage storage) {
  const auto isKept = [&](double v) { return isExact(v * a.scale, storage); };
  if (a.sparse != nullptr) return std::ranges::all_of(a.sparse->value, isKept);
  if (isDirichlet(*a.stencil))
    return isKept(a.stencil->centre) && std::ranges::all_of(a.stencil->along, isKept);
  return std::ranges::all_of(assemble(*a.stencil).value, isKept);
}

Arithmetic doubleArithmetic() {
  return {.precision = sk::Precision::Double,
          .matrix = sk::Storage::Double,
          .vectors = sk::Storage::Double,
          .accumulate = sk::Accumulate::Default};
}

bool hasDoubles(sk::Device& device) {
  try {
    Vector one = device.stream<float>({1}, sk::Storage::Double);
    one.fill(1.0f);
    scaleTo.with(doubleArithmetic().options())(2.0f, one, one);
    return true;
  } catch (const sk::Error& error) {
    if (error.kind() != sk::Error::Kind::Device) throw;
    return false;
  }
}

std::unique_ptr<Residual> makeResidual(sk::Device& device, Matrix& matrix, const Operator& a,
                                       const Arithmetic& arithmetic) {
  if (hasDoubles(device)) return std::make_unique<DeviceResidual>(device, matrix, a, arithmetic);
  return std::make_unique<HostResidual>(a, matrix.space(device), arithmetic.vectors);
}

std::string asymmetryOnDevice(sk::Device& device, Matrix& matrix, const Operator& a,
                              const Arithmetic& arithmetic) {
  if (!a.asymmetry.empty() || a.sparse == nullptr) return a.asymmetry;
  const bool isDouble = hasDoubles(device);
  const Arithmetic in = isDouble ? doubleArithmetic() : arithmetic;
  Vector u, v, p, q;
  for (Vector* w : {&u, &v, &p, &q}) *w = matrix.space(device).stream<float>(in.vectors);
  Vector sum = device.stream<float>({1}, in.sums());
  randomNumbers.with(in.options())(1, u);
  randomNumbers.with(in.options())(2, v);
  matrix.multiplyIn(in, v, p);
  matrix.multiplyIn(in, u, q);
  difference.with(in.foldOptions())(u, p, v, q, sum);
  // Rounding errors of products and sums are independent, each at most a part `unit` of a row sum, which is at most 1.
  const double bound = 8.0 * in.roundoff() * std::sqrt(static_cast<double>(a.size));
  return std::abs(sum.readReals()[0]) <= bound ? "" : findAsymmetry(a);
}

}  // namespace sk::linear
