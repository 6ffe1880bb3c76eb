// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "bench/gui/measure.hpp"

namespace adit::gui::bench {

/// What one process measures. `started`: steady time at which it was started, ms.
Results window_results(double started);
/// The way over the socket of a real station, without robots.
Results socket_results();

}  // namespace adit::gui::bench
