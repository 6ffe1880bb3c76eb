#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "basestation/cli/process/line_socket.hpp"
#include "basestation/cli/process/outbox.hpp"
#include "basestation/station.hpp"

namespace adit::station::cli {

/// The station's socket: takes requests of this user's processes to the station's strand, and answers back.
/// One JSON object a line:
///
///     {"id": 1, "do": "take r1"}       -> {"id": 1, "begun": true}, then {"id": 1, "outcome": {...}}
///     {"id": 2, "teleop": "r1"}        -> the same; {"id": 2, "stick": [vx, vy, wz]} moves it
///     {"cancel": 1}                    ends what runs under the id
///     {"watch": true}                  -> {"snapshot": {...}} five times a second, the newest alone
///     {"notices": true}                -> {"notice": {...}} as they come
///     {"hello": true}                  -> {"hello": {...}}
///     {"front_end": "watch"}           names the client for the others
///
/// Whatever else arrives is answered with {"wrong": "..."}. What a client began ends when it goes.
///
/// Every client, the one that began it included, hears of every command and of how it ended:
///
///     {"event": "command", "id": 7, "phase": "begun", "line": "take r1", "query": false,
///      "mine": false, "by": {"client": 3, "front_end": "shell", "pid": 4711}}
///     the same with "phase": "ended", "exit", "text" and "error"
///
/// A client that does not read misses the oldest notices and events, and reads {"missed": N}. It never misses
/// an outcome: when too many wait it is cut off, with {"cut_off": "why"} as the last line.
class Server {
 public:
  static constexpr std::size_t kMaxClients = 32;
  static constexpr std::size_t kMaxOpen = 32;  ///< requests of one client that have not ended

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
  void notify(const nlohmann::json& notice);

 private:
  struct Client {
    LineSocket socket{};
    Outbox outbox{};
    std::string front_end{"program"};
    pid_t pid{};
    bool cut_off{false};  ///< only what it has not read yet is still sent
    bool watches{false};
    bool notices{false};
    /// Id of the client -> handle of the station, which only the strand writes and reads.
    std::map<std::int64_t, std::shared_ptr<std::uint64_t>> open{};
  };
  /// What the strand has for clients.
  struct Reply {
    enum class Kind : std::uint8_t {
      answer,  ///< for `client`
      notice,  ///< for all that want notices
      event,   ///< for all; `client` began it
    };
    Kind kind{};
    std::uint64_t client{};
    nlohmann::json object{};
  };
  static constexpr std::size_t kMaxHandedOver = 1024;  ///< notices and events on their way from the strand

  Server() = default;
  void accept_client();
  void read(std::uint64_t number, Client& client);
  void handle(std::uint64_t number, Client& client, const std::string& line);
  void begin(std::uint64_t number, Client& client, std::int64_t id, const nlohmann::json& request);
  void hand_over(Reply reply);
  void wake();
  void deliver();
  void deliver(const Reply& reply);
  /// Sends what the client takes; false when it is gone.
  bool push(Client& client);
  void cut_off(Client& client, const std::string& why);
  void cancel_all(Client& client);
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

  std::uint64_t last_command_{};  // of events; the strand's

  std::mutex mutex_{};  // of what follows: written by the strand, read by the serving thread
  std::vector<Reply> replies_{};
  std::size_t handed_over_{};  // notices and events of these
  std::size_t lost_{};         // that found no room
  std::optional<nlohmann::json> snapshot_{};
};

}  // namespace adit::station::cli
