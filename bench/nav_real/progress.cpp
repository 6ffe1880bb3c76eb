// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>

#include "bench/nav_real/rows.hpp"

namespace adit::bench {
namespace {

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Progress::Progress(std::string name, int total, double minutes)
    : name_(std::move(name)), total_(total), end_(minutes > 0 ? now_s() + 60 * minutes : 1e300) {}

bool Progress::next() {
  if (now_s() > end_) return false;
  std::fprintf(stderr, "\r\033[K%s %d/%d ", name_.c_str(), ++done_, total_);
  return true;
}

Progress::~Progress() { std::fprintf(stderr, "\r\033[K"); }

}  // namespace adit::bench
