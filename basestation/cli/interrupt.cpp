// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/interrupt.hpp"

#include <signal.h>

#include <initializer_list>

namespace adit::station::cli {
namespace {

// A signal handler can only access globals.
volatile sig_atomic_t interrupt_flag = 0;
volatile sig_atomic_t resize_flag = 0;

void on_signal(int number) { (number == SIGWINCH ? resize_flag : interrupt_flag) = 1; }

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_signal;  // Without SA_RESTART, poll() returns on a signal.
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGWINCH}) ::sigaction(number, &action, nullptr);
}

bool interrupted() {
  const bool set = interrupt_flag != 0;
  interrupt_flag = 0;
  return set;
}

bool resized() {
  const bool set = resize_flag != 0;
  resize_flag = 0;
  return set;
}

}  // namespace adit::station::cli
