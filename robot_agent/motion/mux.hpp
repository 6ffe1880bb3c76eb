// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "robot_agent/motion/motion.hpp"

namespace adit::agent {

/// A multiplexer that passes exactly one source to navigation, the one that the behaviour tree enabled (rule
/// 5), and zero when that source falls silent (rule 6).
class Mux {
 public:
  /// The input of a source. Valid as long as the mux exists.
  class Output {
   public:
    Output() = default;
    /// Writes a motion. It is passed on immediately if this source is enabled; otherwise it is discarded when
    /// the source is enabled.
    void write(const Motion& motion, Time now) const {
      if (mux_) mux_->write(index_, motion, now);
    }

   private:
    friend class Mux;
    Output(Mux* mux, std::size_t index) : mux_(mux), index_(index) {}
    Mux* mux_{nullptr};
    std::size_t index_{0};
  };

  explicit Mux(NavigationInput& navigation) : navigation_(navigation) {}
  Mux(const Mux&) = delete;
  Mux& operator=(const Mux&) = delete;

  /// Adds a source; its motions are valid for `max_age`. Call it at start-up.
  Output connect(std::string name, Duration max_age);
  /// Enables a source, with zero output during the change; "" or an unknown name: none.
  void enable(std::string_view name, Time now);
  /// Passes the last motion of the enabled source, or zero. Call it at the driver's rate.
  void step(Time now);

  /// Whether the enabled source wrote within its `max_age`.
  bool fresh(Time now) const;

 private:
  /// The output stays zero for this time when the source changes: one period of the driver, so that a driver
  /// that reads only the last command receives the zero.
  static constexpr Duration kSettle = 50ms;
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  struct Input {
    std::string name{};
    Duration max_age{};
    Motion motion{};
    bool written{};
    Time at{};
  };
  void write(std::size_t index, const Motion& motion, Time now);
  void pass(const Motion& motion, Time now) { navigation_.accept(MuxKey{}, motion, now); }

  NavigationInput& navigation_;
  std::vector<Input> inputs_{};
  std::size_t enabled_{kNone};
  Time settled_{};
};

}  // namespace adit::agent
