#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "basestation/cli/process/line_socket.hpp"
#include "basestation/station.hpp"

namespace adit::station::cli {

/// The station's socket: takes requests of this user's processes to the station's strand, and answers back.
/// One JSON object a line:
///
///     {"id": 1, "do": "take r1"}       -> {"id": 1, "begun": true}, then {"id": 1, "outcome": {...}}
///     {"id": 2, "teleop": "r1"}        -> the same; {"id": 2, "stick": [vx, vy, wz]} moves it
///     {"cancel": 1}                    ends what runs under the id
///     {"watch": true}                  -> {"snapshot": {...}} five times a second
///     {"notices": true}                -> {"notice": {...}} as they come
///     {"hello": true}                  -> {"hello": {...}}
///
/// Whatever else arrives is answered with {"wrong": "..."}. What a client began ends when it goes.
class Server {
 public:
  static constexpr std::size_t max_clients = 32;
  static constexpr std::size_t max_open = 32;  ///< requests of one client that have not ended

  /// Takes the name (in_use when another process has it) and listens; a socket that a killed station left is
  /// replaced.
  static Result<std::unique_ptr<Server>> open(const std::string& folder, const std::string& name);
  ~Server();

  /// Serves until `stop_fd` becomes readable or end() was called. Call on the program's main thread;
  /// `station` lives on `strand`.
  void serve(Station& station, Executor& strand, const nlohmann::json& hello, int stop_fd);
  /// From any thread: serve() returns once what is queued has been sent.
  void end();
  /// From any thread: tells those who asked for notices.
  void tell(const nlohmann::json& notice);

 private:
  struct Client {
    LineSocket socket{};
    bool watches{false};
    bool notices{false};
    /// Id of the client -> handle of the station, which only the strand writes and reads.
    std::map<std::int64_t, std::shared_ptr<std::uint64_t>> open{};
  };
  /// What the strand has for a client; client 0: for all that want notices, snapshots for all that watch.
  struct Reply {
    std::uint64_t client{};
    nlohmann::json object{};
  };

  Server() = default;
  void accept_client();
  bool handle(std::uint64_t number, Client& client, const std::string& line);
  void begin(std::uint64_t number, Client& client, std::int64_t id, const nlohmann::json& request);
  void reply(std::uint64_t client, nlohmann::json object);
  void deliver();
  void drop(std::uint64_t number);
  void ask_snapshot();

  std::string path_{};
  File lock_{};
  File listener_{};
  File wake_{};
  Station* station_{};
  Executor* strand_{};
  nlohmann::json hello_{};
  std::map<std::uint64_t, Client> clients_{};
  std::uint64_t next_client_{1};
  std::atomic<bool> ending_{false};
  bool snapshot_asked_{false};

  std::mutex mutex_{};  // of replies_: written by the strand, read by the serving thread
  std::vector<Reply> replies_{};
};

}  // namespace adit::station::cli
