#pragma once
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace adit::station {

/// What an operator can ask. The names are in the grammar (basestation/command/grammar.hpp).
enum class Verb {
  up,
  down,
  list,
  status,
  watch,
  net,
  health,
  findings,
  actions,
  run,
  take,
  release,
  lock,
  unlock,
  grant,
  mode,
  drive,
  go_to,
  plan,
  teleop,
  stop,
  reset,
  restart,
  policy,
};

/// One parsed command line.
struct Request {
  Verb verb{Verb::list};
  std::vector<std::string> robots{};  ///< in the order typed, each once
  bool all{false};                    ///< stop: every robot that is known
  std::string word{};  ///< mode: its name; grant: the operator; run: the file; restart, policy: the component
  /// goto, plan: x y z in the map frame, m (z NaN when not given); drive: vx vy in m/s, wz in rad/s, body
  /// frame
  std::array<double, 3> numbers{0.0, 0.0, std::numeric_limits<double>::quiet_NaN()};
  double duration{1.0};       ///< drive --for: s, (0, 3600]
  bool wait{false};           ///< goto --wait
  bool override_stop{false};  ///< reset --override
  bool automatic{false};      ///< policy R COMPONENT auto
  bool all_operators{false};  ///< run --all
};

}  // namespace adit::station
