// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/program/memory_limit.hpp"

#include <sys/resource.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>

namespace adit::agent {

Result<MemoryUse> memory_use() {
  std::ifstream status("/proc/self/status");
  MemoryUse use{};
  int found = 0;
  for (std::string key, rest; status >> key; std::getline(status, rest)) {
    double kilobytes = 0.0;
    if (key != "VmData:" && key != "RssAnon:" && key != "VmSwap:") continue;
    if (!(status >> kilobytes)) break;
    ++found;
    (key == "VmData:" ? use.reserved : use.touched) += kilobytes / 1024.0;
  }
  if (found < 3) return Error{Reason::cannot_read, "/proc/self/status does not tell the memory in use"};
  return use;
}

Result<double> data_limit(double limit, const MemoryUse& now) {
  if (limit < now.touched + kMinRoom)
    return Error{Reason::out_of_range,
                 "memory_limit: " + std::to_string(static_cast<long>(limit)) + " MB is too little, " +
                     std::to_string(static_cast<long>(std::ceil(now.touched))) +
                     " MB are in use after the start; at least " +
                     std::to_string(static_cast<long>(std::ceil(now.touched + kReportedRoom)))};
  return now.reserved + (limit - now.touched);
}

Result<void> limit_memory(double limit) {
  if (limit <= 0.0) return {};
  const auto use = memory_use();
  if (!use) return use.error();
  const auto data = data_limit(limit, *use);
  if (!data) return data.error();
  const auto bytes = static_cast<rlim_t>(*data * 1024.0 * 1024.0);
  const rlimit bound{bytes, bytes};
  if (::setrlimit(RLIMIT_DATA, &bound) != 0)
    return Error{Reason::cannot_write,
                 std::string("the memory limit cannot be set: ") + std::strerror(errno)};
  return {};
}

}  // namespace adit::agent
