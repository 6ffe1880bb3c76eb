#pragma once
#include <string>

namespace adit::wire {

/// What a radio link gives in one direction. The standard ones are config/links/*.yaml.
struct LinkProfile {
  std::string name{"lan"};
  double bandwidth{100e6};  ///< bit/s shared by all that a sender sends, (0, 1e10]
  double latency{0.001};    ///< one way, s, [0, 10]
  double loss{0.0};         ///< chance that a frame is lost, [0, 1]
  double range{0.0};        ///< m; frames beyond it are lost; 0: no limit
  double queue{0.25};       ///< what waits longer than this to be sent is dropped at the sender, s, (0, 10]
};

}  // namespace adit::wire
