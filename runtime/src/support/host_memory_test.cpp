// SPDX-License-Identifier: MIT
#include "support/host_limits.hpp"

#include <catch2/catch.hpp>

#include "support/test_root.hpp"

using namespace sk;

TEST_CASE("the host's memory is what the kernel tells, and unknown where it does not") {
  const TestRoot root;
  CHECK_FALSE(hostMemory(root.path()).whole.has_value());
  CHECK_FALSE(hostMemory(root.path()).available.has_value());
  root.write("proc/meminfo", "MemTotal:        8000 kB\nMemFree:  100 kB\nMemAvailable:    5000 kB\n");
  CHECK(hostMemory(root.path()).whole == 8000 * 1024);
  CHECK(hostMemory(root.path()).available == 5000 * 1024);
}

TEST_CASE("control groups limit memory, the tightest first") {
  const TestRoot root;
  root.write("proc/meminfo", "MemTotal: 8000 kB\nMemAvailable: 5000 kB\n");
  root.write("proc/self/cgroup", "0::/outer/inner\n");
  root.write("sys/fs/cgroup/outer/inner/memory.max", "max\n");
  CHECK(hostMemory(root.path()).available == 5000 * 1024);
  root.write("sys/fs/cgroup/outer/memory.max", "3000000\n");
  root.write("sys/fs/cgroup/outer/memory.current", "1000000\n");
  root.write("sys/fs/cgroup/outer/memory.stat", "anon 5\ninactive_file 400000\n");
  CHECK(hostMemory(root.path()).whole == 3000000);
  CHECK(hostMemory(root.path()).available == 2400000);
  root.write("sys/fs/cgroup/outer/inner/memory.max", "500000\n");
  root.write("sys/fs/cgroup/outer/inner/memory.current", "600000\n");
  CHECK(hostMemory(root.path()).whole == 500000);
  CHECK(hostMemory(root.path()).available == 0);
}

TEST_CASE("control groups of version 1 limit memory, too") {
  const TestRoot root;
  root.write("proc/meminfo", "MemTotal: 8000 kB\nMemAvailable: 5000 kB\n");
  root.write("proc/self/cgroup", "5:cpu,cpuacct:/elsewhere\n4:hugetlb,memory:/docker/one\n0::/unified\n");
  const std::filesystem::path all = "sys/fs/cgroup/memory";
  root.write(all / "memory.limit_in_bytes", "9223372036854771712\n");
  CHECK(hostMemory(root.path()).available == 5000 * 1024);
  root.write(all / "docker/one/memory.limit_in_bytes", "3000000\n");
  root.write(all / "docker/one/memory.usage_in_bytes", "1000000\n");
  root.write(all / "docker/one/memory.stat", "inactive_file 7\ntotal_inactive_file 400000\n");
  CHECK(hostMemory(root.path()).whole == 3000000);
  CHECK(hostMemory(root.path()).available == 2400000);
  // A container that sees its own group as the outermost one.
  root.write(all / "memory.limit_in_bytes", "2000000\n");
  root.write(all / "memory.usage_in_bytes", "500000\n");
  CHECK(hostMemory(root.path()).available == 1500000);
}
