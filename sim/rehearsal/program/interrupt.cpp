// SPDX-License-Identifier: Apache-2.0
#include "sim/rehearsal/program/interrupt.hpp"

#include <atomic>
#include <csignal>

namespace adit::sim {
namespace {

std::atomic<bool> came{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void note(int signal) {
  came = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void note_interrupts() {
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

bool interrupted() { return came; }

}  // namespace adit::sim
