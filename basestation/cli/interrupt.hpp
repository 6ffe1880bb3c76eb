#pragma once

namespace adit::station::cli {

/// From now on SIGINT, SIGTERM and SIGHUP only set a flag and interrupt what waits.
void catch_interrupts();
/// True once after such a signal.
bool interrupted();
/// True when the window changed its size since the last call; needs catch_interrupts().
bool resized();

}  // namespace adit::station::cli
