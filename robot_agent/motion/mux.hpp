#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "robot_agent/motion/motion.hpp"

namespace adit::agent {

struct MuxParams {
  /// The output stays zero for so long when the source changes: one period of the driver, so that the zero
  /// is seen by a reader that keeps only the last command.
  Duration settle{50ms};
};

/// Passes exactly one source to navigation, the one that the behaviour tree enabled (rule 5), and zero when
/// that one falls silent (rule 6).
class Mux {
 public:
  /// A source's way in. Valid as long as the mux.
  class Output {
   public:
    Output() = default;
    /// Passed on at once when this source is enabled; else kept until the next write, and forgotten when the
    /// source is enabled.
    void write(const Motion& motion, Time now) const {
      if (mux_) mux_->write(index_, motion, now);
    }

   private:
    friend class Mux;
    Output(Mux* mux, std::size_t index) : mux_(mux), index_(index) {}
    Mux* mux_{nullptr};
    std::size_t index_{0};
  };

  explicit Mux(NavigationInput& navigation, MuxParams params = {})
      : navigation_(navigation), params_(params) {}
  Mux(const Mux&) = delete;
  Mux& operator=(const Mux&) = delete;

  /// A new source; what it wrote counts for `max_age`. At start-up.
  Output connect(std::string name, Duration max_age);
  /// From now on this source passes; "" (or a name that nobody connected): none. Through zero.
  void enable(std::string_view name, Time now);
  /// Passes what the enabled source said last, or zero. At the driver's rate.
  void step(Time now);

  /// The enabled source; empty: none.
  const std::string& enabled() const;
  /// The enabled source spoke within its age.
  bool fresh(Time now) const;

 private:
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
  MuxParams params_;
  std::vector<Input> inputs_{};
  std::size_t enabled_{kNone};
  Time settled_{};
};

}  // namespace adit::agent
