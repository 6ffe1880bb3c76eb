// SPDX-License-Identifier: Apache-2.0
#include "bench/soak/gauge.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace adit::soak {
namespace {

namespace fs = std::filesystem;

long entries(const std::string& folder) {
  std::error_code gone;  // the process may end while we look
  long count = 0;
  for (fs::directory_iterator it(folder, gone), end; !gone && it != end; it.increment(gone)) ++count;
  return count;
}

double growth(const std::vector<double>& samples, std::size_t from) {
  std::vector<double> slopes;
  for (std::size_t i = from; i < samples.size(); ++i)
    for (std::size_t j = i + 1; j < samples.size(); ++j)
      slopes.push_back((samples[j] - samples[i]) / static_cast<double>(j - i));
  if (slopes.empty()) return 0.0;
  // A little below the median: of a step in the very middle half of all pairs have a part.
  const auto at = slopes.begin() + static_cast<long>(0.45 * static_cast<double>(slopes.size()));
  std::nth_element(slopes.begin(), at, slopes.end());
  return *at * static_cast<double>(samples.size() - from);
}

}  // namespace

Gauge gauge(pid_t pid) {
  const std::string proc = "/proc/" + std::to_string(pid);
  Gauge out;
  std::ifstream memory(proc + "/statm");
  double all = 0.0, resident = 0.0;
  if (memory >> all >> resident) out.rss_mb = resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
  out.threads = entries(proc + "/task");
  out.fds = entries(proc + "/fd");
  return out;
}

std::vector<pid_t> children(pid_t pid) {
  std::vector<pid_t> out;
  std::error_code gone;  // the process may end while we look
  const std::string tasks = "/proc/" + std::to_string(pid) + "/task";
  for (fs::directory_iterator it(tasks, gone), end; !gone && it != end; it.increment(gone)) {
    std::ifstream file(it->path() / "children");
    out.insert(out.end(), std::istream_iterator<pid_t>(file), {});
  }
  return out;
}

SharedMemory shared_memory() {
  SharedMemory out;
  std::error_code gone;  // files come and go
  for (fs::directory_iterator it("/dev/shm", gone), end; !gone && it != end; it.increment(gone)) {
    std::error_code removed;
    const auto size = it->file_size(removed);
    if (removed) continue;
    ++out.files;
    out.mb += static_cast<double>(size) / 1e6;
  }
  return out;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double maximum(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

Trend trend(const std::vector<double>& samples) {
  const long n = static_cast<long>(samples.size()), fifth = std::max(n / 5, 1L);
  if (n == 0) return {};
  const auto part = [&](long from) {
    const long begin = std::clamp(from, 0L, n - 1), end = std::min(begin + fifth, n);
    return median({samples.begin() + begin, samples.begin() + end});
  };
  return {part(fifth), part(n - fifth), maximum(samples),
          growth(samples, static_cast<std::size_t>(std::min(fifth, n - 1)))};
}

}  // namespace adit::soak
