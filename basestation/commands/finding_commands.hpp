// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>

#include "basestation/commands/outcome.hpp"
#include "basestation/content/content.hpp"

namespace adit::station {

/// The commands `finding ...`: what the operator decides about findings, and his own marks.
class FindingCommands {
 public:
  using Done = std::function<void(const Outcome&)>;

  FindingCommands(const StationParams& params, Executor& strand, const Fleet& fleet, Content& content)
      : params_(params), strand_(strand), fleet_(fleet), content_(content) {}

  /// Runs the command; `done` is called once, at once or when the disk has it.
  void run(const command::Request& request, const Done& done);
  /// Runs `findings --export FILE`; it writes on a thread of the pool, so that it delays no command.
  void write_file(const command::Request& request, const Done& done);

 private:
  void add(const command::Request& request, const Done& done);
  /// Reads and stores the photo of a mark, then adds the mark.
  void add_with_photo(const command::Request& request, const Mark& mark, const Done& done);
  void put(const command::Request& request, const Mark& mark, const Done& done);
  void write_photo(const command::Request& request, const findings::Key& key, const Done& done);
  void remove(const command::Request& request, const findings::Key& key, const Done& done);
  void judge(const command::Request& request, const findings::Key& key, const Done& done);

  const StationParams& params_;
  Executor& strand_;
  const Fleet& fleet_;
  Content& content_;
  std::shared_ptr<bool> alive_{std::make_shared<bool>(true)};
};

}  // namespace adit::station
