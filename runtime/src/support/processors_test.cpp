// SPDX-License-Identifier: MIT
#include "support/host_limits.hpp"

#include <catch2/catch.hpp>

#include "support/test_root.hpp"

namespace sk {
namespace {

TEST_CASE("quotas of control groups limit the processors") {
  const TestRoot root;
  CHECK(withinQuota(8, root.path()) == 8);  // no groups at all
  root.write("proc/self/cgroup", "0::/outer/inner\n");
  root.write("sys/fs/cgroup/outer/inner/cpu.max", "max 100000\n");
  CHECK(withinQuota(8, root.path()) == 8);
  root.write("sys/fs/cgroup/outer/cpu.max", "350000 100000\n");
  CHECK(withinQuota(8, root.path()) == 3);
  CHECK(withinQuota(2, root.path()) == 2);
  root.write("sys/fs/cgroup/outer/inner/cpu.max", "50000 100000\n");
  CHECK(withinQuota(8, root.path()) == 1);
  root.write("sys/fs/cgroup/outer/inner/cpu.max", "nonsense\n");
  CHECK(withinQuota(8, root.path()) == 3);
}

TEST_CASE("quotas of the first version of control groups count as well") {
  const TestRoot root;
  root.write("proc/self/cgroup", "5:memory:/x\n4:cpu,cpuacct:/docker/abc\n0::/\n");
  root.write("sys/fs/cgroup/cpu/docker/abc/cpu.cfs_quota_us", "-1\n");
  root.write("sys/fs/cgroup/cpu/docker/abc/cpu.cfs_period_us", "100000\n");
  CHECK(withinQuota(8, root.path()) == 8);
  root.write("sys/fs/cgroup/cpu/docker/abc/cpu.cfs_quota_us", "200000\n");
  CHECK(withinQuota(8, root.path()) == 2);
  root.write("sys/fs/cgroup/cpu/docker/cpu.cfs_quota_us", "100000\n");
  root.write("sys/fs/cgroup/cpu/docker/cpu.cfs_period_us", "100000\n");
  CHECK(withinQuota(8, root.path()) == 1);
}

TEST_CASE("ranks that are not bound to processors share them") {
  CHECK(shareOfRank(8, 8, 1) == 8);
  CHECK(shareOfRank(8, 8, 3) == 2);
  CHECK(shareOfRank(8, 8, 100) == 1);
  CHECK(shareOfRank(2, 8, 4) == 2);   // bound to their own
  CHECK(shareOfRank(16, 32, 8) == 4);  // four of them share a socket
}

}  // namespace
}  // namespace sk
