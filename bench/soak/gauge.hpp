// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <map>
#include <string>
#include <vector>

namespace adit::soak {

/// What a process holds at one moment.
struct Gauge {
  double rss_mb{};
  long threads{}, fds{};
};
/// Zeros for a process that is gone.
Gauge gauge(pid_t pid);
/// Direct children.
std::vector<pid_t> children(pid_t pid);

/// Files in /dev/shm.
struct SharedMemory {
  long files{};
  double mb{};
};
SharedMemory shared_memory();

/// The samples of one process, or of shared memory, over the run.
struct Series {
  std::vector<double> rss_mb{};
  std::vector<double> threads{}, fds{};
  void add(const Gauge& g) {
    rss_mb.push_back(g.rss_mb);
    threads.push_back(static_cast<double>(g.threads));
    fds.push_back(static_cast<double>(g.fds));
  }
};

/// Of some samples: medians of the second fifth (the first is start-up) and of the last fifth, and the growth
/// from there to the end: the 45 % quantile of the slopes between any two samples (after Theil and Sen),
/// times their number. A step (a port opened once, a cache filled), or a burst, is no growth; what goes on
/// is.
struct Trend {
  double early{}, late{}, max{}, growth{};
};
Trend trend(const std::vector<double>& samples);
double median(std::vector<double> values);
double maximum(const std::vector<double>& values);

}  // namespace adit::soak
