// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "basestation/client/line_socket.hpp"
#include "basestation/host/outbox.hpp"
#include "basestation/model/camera.hpp"
#include "basestation/model/delta.hpp"
#include "basestation/model/notice.hpp"
#include "basestation/model/world.hpp"
#include "basestation/station/station.hpp"

namespace adit::station::host {

/// The server of the station's socket: passes requests of this user's processes to the station's strand, and
/// returns the answers. One JSON object per line:
///
///     {"id": 1, "do": "take r1"}       -> {"id": 1, "begun": true}, then {"id": 1, "outcome": {...}}
///     {"id": 2, "teleop": "r1"}        -> the same; {"id": 2, "stick": [vx, vy, wz]} drives
///     {"cancel": 1}                    ends the request with the id
///     {"follow": true}                 -> {"world": {...}}, then {"delta": {...}}, see below
///     {"notices": true}                -> {"notice": {...}} on each notice
///     {"map": {"run": N, "revision": M, "look": [x, y, radius]}}
///                                      -> {"map": {...}, "more": true|false}: the tiles that changed since;
///                                      `look`, which may be missing: what robots are to send first
///     {"id": 3, "photo": "HASH", "part": "picture"}
///                                      -> {"id": 3, "outcome": {...}} with the bytes
///                                      (model/photo_bytes.hpp); `part` may also be "thumbnail"; `HASH`:
///                                      FoundPhoto::id
///     {"id": 4, "camera": "front", "robot": "r1", "width": 640, "rate": 15, "after": N}
///                                      -> {"id": 4, "outcome": {...}} with the next picture after number N
///                                      (model/camera_bytes.hpp), or none within a second. The camera is
///                                      looked at for 3 s from each such request
///     {"hello": true}                  -> {"hello": {...}}
///     {"front_end": "watch", "folder": "/home/op"}
///                                      names the client for the others; files in its lines are relative to
///                                      `folder`, which may be missing
///
/// A delta (model/delta.hpp) leads from the state that the client read last to the newest one. It comes when
/// something changed: at most every 20 ms, every 100 ms if only robots moved, and at least every 0.4 s.
///
/// Any other line is answered with {"wrong": "..."}. The requests of a client end when it disconnects.
///
/// Every client, including the one that began it, receives the begin and the end of every command:
///
///     {"event": "command", "id": 7, "phase": "begun", "line": "take r1", "query": false,
///      "mine": false, "by": {"front_end": "shell", "pid": 4711}}
///     the same with "phase": "ended", "exit", "text" and "error"
///
/// A client that does not read misses the oldest notices and events, and reads {"missed": N}. It never misses
/// an outcome: if too many are unread, it is disconnected, with {"cut_off": "why"} as the last line.
class Server {
 public:
  static constexpr std::size_t kMaxClients = 32;
  static constexpr std::size_t kMaxOpen = 32;  ///< Open requests of one client.

  /// Locks the name (in_use if another process has it) and listens; the socket of a killed station is
  /// replaced.
  static Result<std::unique_ptr<Server>> open(const std::string& folder, const std::string& name);
  ~Server();

  /// Serves until `stop_fd` becomes readable or end() is called. Call it on the program's main thread;
  /// `station` lives on `strand`.
  void serve(Station& station, Executor& strand, const nlohmann::json& hello, int stop_fd);
  /// Makes serve() return once all queued lines are sent. Callable from any thread.
  void end();
  /// Sends a notice to the clients that requested notices. Callable from any thread.
  void notify(const Notice& notice);
  /// Sends the clients that follow what changed. Call it on the station's strand.
  void changed(const Station& station);

 private:
  struct Client {
    client::LineSocket socket{};
    Outbox outbox{};
    std::string front_end{"program"};
    std::string folder{};  ///< To which files in its command lines are relative; empty: the station's own.
    pid_t pid{};
    bool cut_off{false};  ///< Only its unread lines are still sent.
    bool follows{false};
    std::shared_ptr<const EncodedWorld> sent{};  ///< The state that a client that follows has; null: none.
    std::chrono::steady_clock::time_point sent_at{};
    bool notices{false};
    bool map_asked{false};  ///< It waits for a part of the map.
    /// Maps the client's request id to the station's handle, which only the strand writes and reads.
    std::map<std::int64_t, std::shared_ptr<std::uint64_t>> open{};
  };
  /// A message of the strand for clients.
  struct Reply {
    enum class Kind : std::uint8_t {
      answer,  ///< For `client`.
      notice,  ///< For all clients that requested notices.
      event,   ///< For all clients; `client` began it.
    };
    Kind kind{};
    std::uint64_t client{};
    nlohmann::json object{};
  };
  static constexpr std::size_t kMaxHandedOver = 1024;  ///< Notices and events queued by the strand.

  Server() = default;
  void accept_client();
  void read(std::uint64_t number, Client& client);
  void handle(std::uint64_t number, Client& client, const std::string& text);
  /// Runs a command line, or manual control of a robot, as the client's request `id`.
  void begin(std::uint64_t number, Client& client, std::int64_t id, const std::string& line,
             const std::string& robot);
  void ask_map(std::uint64_t number, Client& client, const nlohmann::json& wanted);
  /// Opens the client's request `id`; the function, from any thread, answers it with an outcome.
  std::function<void(const nlohmann::json& outcome)> open_request(std::uint64_t number, Client& client,
                                                                  std::int64_t id);
  /// Answers the client's request `id` for a part of a photo.
  void ask_photo(std::uint64_t number, Client& client, std::int64_t id, const std::string& photo,
                 const std::string& part);
  /// Answers the client's request `id` for the next picture of a camera.
  void ask_camera(std::uint64_t number, Client& client, std::int64_t id, const CameraRequest& wanted);
  /// Queues an answer; a client with too many unread ones is cut off.
  void answer(Client& client, const nlohmann::json& object);
  void hand_over(Reply reply);
  void wake();
  void deliver();
  void deliver(const Reply& reply);
  /// Sends as many lines as the client accepts; returns false if it disconnected.
  bool push(Client& client);
  void cut_off(Client& client, const std::string& why);
  void cancel_all(Client& client);
  void drop(std::uint64_t number);
  /// Asks the strand for the state, unless it has too much to do.
  void ask_world();
  void take(World world);
  /// Sends a client that follows what it does not have, if that is due. Returns whether something is left.
  bool follow(Client& client, std::chrono::steady_clock::time_point now);

  std::string path_{};
  client::File lock_{};
  client::File listener_{};
  client::File wake_{};
  Station* station_{};
  Executor* strand_{};
  nlohmann::json hello_{};
  std::map<std::uint64_t, Client> clients_{};
  std::uint64_t next_client_{1};
  std::atomic<bool> ending_{false};
  std::atomic<int> followers_{0};
  std::shared_ptr<const EncodedWorld> newest_{};  ///< The state now, for clients that follow.
  std::optional<World> newest_world_{};           ///< The same, with its notices.

  std::uint64_t run_{};           // Number of this run of the station, for the map's revisions.
  std::uint64_t last_command_{};  // Id of the last command event; used on the strand.

  std::mutex mutex_{};  // Guards the members below: the strand writes them, the serving thread reads them.
  std::vector<Reply> replies_{};
  std::size_t handed_over_{};  // Notices and events in `replies_`.
  std::size_t lost_{};         // Notices and events that were dropped.
  std::optional<World> world_{};
};

}  // namespace adit::station::host
