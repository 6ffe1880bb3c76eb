// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "basestation/findings/desk.hpp"
#include "core/exec/executor.hpp"
#include "core/findings/mark_data.hpp"
#include "core/time/random.hpp"

namespace adit::station {

/// What an operator marks on the map.
struct Mark {
  std::string kind{};
  std::array<double, 3> position{};  ///< Map frame, m.
  std::string text{};
  std::optional<findings::PhotoRef> photo{};
};

/// The marks of this station's operator: findings of the station itself, on its desk and its disk. They are
/// withdrawn, never deleted, so that each station that has a mark hears of it.
class Marks {
 public:
  static constexpr std::size_t kMaxMarks = FindingDesk::kMaxMarks;
  static constexpr std::size_t kMaxWaiting = 64;  ///< Marks that are being written.
  static constexpr Duration kPatience = std::chrono::seconds(2);
  /// `on_disk`: false when the disk did not answer within kPatience; the mark is in memory then, and the disk
  /// is tried again.
  using Done = std::function<void(const findings::Finding&, bool on_disk)>;

  /// `station`: the operator's name. `seed`: of ids, another one at each start.
  Marks(std::string station, const findings::Owner& id, std::uint64_t seed, FindingDesk& desk,
        Executor& home);

  /// Adds a mark; `done` is called once, at once or later. Errors: bad_argument (kind, text or place),
  /// queue_full.
  Result<void> add(const Mark& mark, Done done);
  /// Withdraws a mark. Errors: bad_argument (it is no mark of this station, or is withdrawn), queue_full.
  Result<void> remove(const findings::Key& key, Done done);
  /// Whether a finding is a mark of this station.
  bool is_own(const findings::Finding& finding) const;
  /// The owner of this station's marks.
  const findings::Owner& owner() const { return id_; }
  /// The key of this station's mark of that id.
  findings::Key key_of(std::uint64_t id) const { return {station_, id, id_}; }
  /// Time since a mark of this station was added, s; nothing: it was in an earlier run, whose clock is not
  /// known, or by another station.
  std::optional<double> age(const findings::Finding& finding) const;

 private:
  struct Waiting {
    Done done{};
    findings::Finding mark{};
    Timer timer{};
  };
  Result<void> put(findings::Finding mark, Done done);
  void end(std::uint64_t number, bool on_disk);

  std::string station_;
  findings::Owner id_;
  Random random_;
  FindingDesk& desk_;
  Executor& home_;
  std::map<findings::Key, Time> added_{};  ///< In this run; at most kMaxMarks.
  std::uint64_t next_{};
  std::map<std::uint64_t, Waiting> waiting_{};
  std::shared_ptr<bool> alive_{std::make_shared<bool>(true)};
};

}  // namespace adit::station
