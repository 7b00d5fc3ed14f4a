// SPDX-License-Identifier: MIT
//
// A repeated call allocates no host memory, and a software renderer needs no new pages for it. This is a separate program,
// because it replaces operator new to count every allocation, and counts page faults of the whole process.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <vector>

#include <sys/resource.h>

#include "sk/sk.hpp"
#include "test_kernel.hpp"

namespace {

std::atomic<long> allocations{0};

void* allocate(std::size_t size) noexcept {
  ++allocations;
  return std::malloc(size == 0 ? 1 : size);
}

void* allocateOrThrow(std::size_t size) {
  if (void* memory = allocate(size)) {
    return memory;
  }
  throw std::bad_alloc();
}

}  // namespace

// Replaces all of them: drivers are C++, too, and use the program's.
void* operator new(std::size_t size) { return allocateOrThrow(size); }
void* operator new[](std::size_t size) { return allocateOrThrow(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }

namespace {

using namespace sk;
using namespace sk::test;

/// The number of allocations of a call that has been made twice before.
template <class Call>
long allocationsOf(Call call) {
  call();
  call();
  const long before = allocations;
  call();
  return allocations - before;
}

bool check(const char* what, long found) {
  std::printf("%s: %ld allocation(s)\n", what, found);
  return found == 0;
}

bool checkAll(Device& device) {
  static const TestKernel saxpy(
      "saxpy", "void saxpy(float a, float x, float y, out float r) { r = a * x + y; }\n",
      {uniform<float>("a"), input<float>("x"), input<float>("y"), output<float>("r")});
  static const TestKernel two(
      "two", "void two(out float r, out vec2 s) { r = sk_near_g(ivec2(1, 0)); s = vec2(r); }\n",
      {gather<float>("g", 2), output<float>("r"), output<float2>("s")});
  auto x = device.stream<float>({40, 50});
  auto y = device.stream<float>({40, 50});
  auto r = device.stream<float>({40, 50});
  auto s = device.stream<float2>({40, 50});
  auto line = device.stream<float>(3000);
  auto result = device.stream<float>(3000);
  float a = 0;
  const auto view = r.domain({1, 1}, {20, 30});
  bool isFree = check("planes", allocationsOf([&] { saxpy(++a, x, y, r); }));
  isFree = check("linearised", allocationsOf([&] { saxpy(a, line, line, result); })) && isFree;
  isFree =
      check("a view",
            allocationsOf([&] { saxpy(a, x.domain({1, 1}, {20, 30}), y.domain({2, 2}, {21, 31}), view); })) &&
      isFree;
  isFree = check("two outputs", allocationsOf([&] { two(x, r, s); })) && isFree;
  return isFree;
}

long pagesSoFar() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

/// Makes calls with a new uniform each, for which llvmpipe allocates from the heap. After a warm-up, fewer than one call in
/// four may need a new page (gl_device/gl_memory.cpp); without keepHeap(), each call needs about four.
bool checkPages(Device& device) {
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
  static const TestKernel scale("scale", "void scale(float a, float x, out float r) { r = a * x; }\n",
                                {uniform<float>("a"), input<float>("x"), output<float>("r")});
  if (!device.isSoftware()) return true;
  auto x = device.stream<float>({8, 8}), r = device.stream<float>({8, 8});
  x.write(std::vector<float>(64, 1));
  const auto callOften = [&] {
    for (int i = 0; i < 1000; ++i) scale(static_cast<float>(i), x, r);
    device.finish();
  };
  for (int warm = 0; warm < 4; ++warm) callOften();
  const long before = pagesSoFar();
  for (int round = 0; round < 4; ++round) callOften();
  const long found = pagesSoFar() - before;
  std::printf("4000 calls: %ld new page(s)\n", found);
  return found < 1000;
#else
  return true;
#endif
}

}  // namespace

int main() {
  Device device({.textureLimit = 64});
  const bool isFree = checkAll(device);
  bool hasPages = checkPages(device);
  // On a busy machine, llvmpipe's queues sometimes settle at another length, and take a page for each call.
  for (int again = 0; again < 3 && !hasPages; ++again) {
    Device other({.textureLimit = 64});
    hasPages = checkPages(other);
  }
  return hasPages && isFree ? 0 : 1;
}
