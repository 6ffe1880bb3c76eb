// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "basestation/model/found.hpp"
#include "core/exec/executor.hpp"
#include "core/findings/finding.hpp"
#include "core/store/disk.hpp"

namespace adit::station {

/// The operator's judgement of each finding, and the numbers by which commands name findings. Stored in
/// one file on this station's disk. Writing runs on a thread of the pool, so that it delays no command.
class FindingBook {
 public:
  static constexpr std::size_t kMaxNote = 200;  ///< Length of a note, bytes.
  static constexpr std::size_t kMaxEntries = 65536;
  struct Judgement {
    std::uint32_t number{};
    Verdict verdict{Verdict::open};
    std::string note{};
  };
  using Written = std::function<void(const Result<void>&)>;

  /// `disk` null: in memory only.
  FindingBook(std::shared_ptr<store::Disk> disk, Executor& home);
  ~FindingBook();

  /// Reads the file. A damaged file is renamed to judgements.bad; returns a text for operators, or nothing.
  std::string load();
  /// Gives a new finding the next number; one that is known keeps its own.
  void add(const findings::Key& key);
  const Judgement* find(const findings::Key& key) const;
  /// The key of the finding with that number; null: there is none.
  const findings::Key* key_of(std::uint32_t number) const;
  /// Change an entry that exists; `written` is called once, when it is on disk or cannot be written.
  void judge(const findings::Key& key, Verdict verdict, Written written);
  void note(const findings::Key& key, const std::string& text, Written written);

  std::function<void()> on_change{};  ///< Called after each change of an entry; may be empty.

 private:
  void write();
  void changed(Written written);
  std::string as_text() const;
  bool read(const std::string& text);

  std::shared_ptr<store::Disk> disk_;
  Executor& home_;
  std::map<findings::Key, Judgement> entries_{};
  std::uint32_t next_{1};
  bool changed_{false}, writing_{false};
  std::vector<Written> waiting_{};
  std::shared_ptr<bool> alive_{std::make_shared<bool>(true)};
};

}  // namespace adit::station
