// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>

#include "basestation/commands/outcome.hpp"
#include "basestation/content/content.hpp"
#include "basestation/map/picture.hpp"
#include "basestation/map/trails.hpp"

namespace adit::station {

/// The commands `map ...`. Merging and writing run on a thread of the pool, so that they delay no command.
class MapCommands {
 public:
  using Done = std::function<void(const Outcome&)>;

  MapCommands(const StationParams& params, Executor& strand, const Fleet& fleet, Content& content)
      : params_(params), strand_(strand), fleet_(fleet), content_(content) {}

  void run(const command::Request& request, const Done& done);
  /// Extends the robots' trails to where they are now.
  void follow_robots();

 private:
  void save(const command::Request& request, const Done& done);
  void load(const command::Request& request, const Done& done);
  void draw(const command::Request& request, const Done& done);
  Outcome status(const command::Request& request) const;
  MapPicture picture() const;

  const StationParams& params_;
  Executor& strand_;
  const Fleet& fleet_;
  Content& content_;
  Trails trails_{};
  std::shared_ptr<bool> alive_{std::make_shared<bool>(true)};
};

}  // namespace adit::station
