// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <mutex>
#include <thread>

#include "tests/gui/crew/crew.hpp"

namespace adit::gui::crew {

/// Ten operators in shells of one station, each with one robot: each looks at its robot all the time and acts
/// at once.
class ShellOperators {
 public:
  static constexpr std::chrono::milliseconds kLook{500};  ///< Between two looks.

  ShellOperators(const Mission& mission, const Crew& crew);
  ~ShellOperators();
  std::array<Progress, kRobots> progress() const;
  /// Commands that were given so far, and those of them that were refused.
  int commands() const { return commands_; }
  int refused() const { return refused_; }

 private:
  void operate(std::size_t robot);

  const Mission& mission_;
  const Crew& crew_;
  mutable std::mutex mutex_{};
  std::array<Progress, kRobots> progress_{};
  std::atomic<int> commands_{0}, refused_{0};
  std::atomic<bool> ends_{false};
  std::vector<std::thread> threads_{};
};

}  // namespace adit::gui::crew
