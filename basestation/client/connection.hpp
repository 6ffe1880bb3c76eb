// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "basestation/client/line_socket.hpp"
#include "basestation/client/options.hpp"
#include "basestation/model/camera.hpp"
#include "basestation/model/map_tiles.hpp"
#include "basestation/model/outcome.hpp"
#include "basestation/model/world.hpp"
#include "core/findings/photo_file.hpp"

namespace adit::station {
class WorldBuilder;
}

namespace adit::station::client {

/// A connection of one process to its station, for one thread. Callbacks run within wait().
class Connection {
 public:
  /// `front_end`: name under which the station's other clients see this client's commands. Files in its
  /// command lines are relative to the process's folder at this time.
  Connection(LineSocket socket, const std::string& front_end);
  ~Connection();

  std::function<void(const World&)> on_world{};
  std::function<void(const Notice&)> on_notice{};
  /// Called when a command of this or another client began or ended.
  std::function<void(const CommandEvent&)> on_command{};
  /// `more`: ask again from the update's revision on.
  std::function<void(MapUpdate, bool more)> on_map{};
  /// Called with the number of notices and command events that were lost because this client did not read.
  std::function<void(std::size_t)> on_missed{};
  /// Called with the answer to hello(): name, domain, link, interfaces and peers of the running station.
  std::function<void(const StationOptions&)> on_hello{};
  std::function<void(std::int64_t id)> on_begun{};
  std::function<void(std::int64_t id, const CommandOutcome& outcome)> on_outcome{};

  /// Send a request; each returns the request's id.
  std::int64_t execute(const std::string& line);
  std::int64_t teleop(const std::string& robot);
  /// The stick of a teleop: m/s, m/s, rad/s.
  void stick(std::int64_t id, double vx, double vy, double wz);
  /// Asks for the next picture of a camera; camera_picture_of() reads the outcome.
  std::int64_t camera(const CameraRequest& request);
  /// Asks for the bytes of a part of a photo. `id`: FoundPhoto::id.
  std::int64_t photo(const std::string& id, findings::PhotoPart part);
  void cancel(std::int64_t id);
  void hello();
  /// Asks for the state whenever it changes: on_world is called with each.
  void follow();
  void notices();
  /// Asks once for what changed of the map after that revision of that run of the station. `look`: robots
  /// send first what is there.
  void map(std::uint64_t run, std::uint64_t revision, const std::optional<LookedAt>& look = {});

  /// Handles the messages that arrive within `timeout_ms`, or until `other_fd` (-1: none) has input. Returns
  /// false if the connection to the station is closed.
  bool wait(int timeout_ms, int other_fd = -1);
  bool connected() const { return connected_; }
  /// Why the connection to the station is closed.
  std::string gone() const;
  /// The first message that this version does not understand; empty: there was none.
  const std::string& not_understood() const { return not_understood_; }

 private:
  void send(const std::string& line);
  void handle(const std::string& line);

  LineSocket socket_;
  std::int64_t next_{1};
  bool connected_{true};
  bool can_send_{true};  ///< False after a failed send; wait() still reads what the station wrote before.
  std::string cut_off_{};
  std::string not_understood_{};
  std::unique_ptr<WorldBuilder> world_{};  ///< Of a connection that follows.
};

/// Joins words into one line that splits into the same words.
std::string quoted(const std::vector<std::string>& words);

}  // namespace adit::station::client
