// SPDX-License-Identifier: Apache-2.0
#include "core/exec/processor_use.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace adit {
namespace {

/// Returns the beginning of a file as text, "" when it cannot be read.
template <std::size_t N>
void read_text(const char* path, char (&text)[N]) {
  text[0] = '\0';
  const int fd = ::open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return;
  const ssize_t got = ::read(fd, text, N - 1);
  ::close(fd);
  text[std::max<ssize_t>(got, 0)] = '\0';
}

}  // namespace

Duration own_processor_time() {
  timespec ran{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &ran);
  return std::chrono::seconds(ran.tv_sec) + std::chrono::nanoseconds(ran.tv_nsec);
}

std::optional<ProcessorUse> processor_use(int thread_id) {
  char path[64], text[256];
  std::snprintf(path, sizeof path, "/proc/self/task/%d/schedstat", thread_id);
  read_text(path, text);
  std::int64_t ran = 0, waited = 0;
  if (std::sscanf(text, "%" SCNd64 " %" SCNd64, &ran, &waited) != 2 || ran == 0) return std::nullopt;
  std::snprintf(path, sizeof path, "/proc/self/task/%d/stat", thread_id);
  read_text(path, text);
  const char* name_end = std::strrchr(text, ')');  // A thread name may contain any character.
  if (!name_end || name_end[1] != ' ') return std::nullopt;
  return ProcessorUse{Duration(ran), Duration(waited), name_end[2] == 'R'};
}

Duration answerable(const ProcessorUse& before, const ProcessorUse& now, Duration passed) {
  const Duration own = now.ready ? now.ran - before.ran : passed - (now.waited - before.waited);
  return std::clamp(own, Duration{}, std::max(passed, Duration{}));
}

}  // namespace adit
